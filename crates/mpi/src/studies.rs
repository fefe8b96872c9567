//! Studies over the ranks of an MPI program: each rank computes the next part as it comes free, and rank 0 makes the results.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use stridor::case::Case;
use stridor::error::{Error, Fault, Result};
use stridor::job::{merge_parts, origin, parts_done, parts_folder, run_parts};
use stridor::progress::Observer;
use stridor::results::RunResults;
use stridor_mpi::distributed::{Deal, first_that_differs};
use stridor_mpi::slepc::World;

/// Parts for each rank: more of them share the work more evenly, and repeat more of it.
const PARTS_FOR_A_RANK: usize = 4;
/// The list of ranks and the parts that they got, in the folder of the parts.
const LIST: &str = "ranks.txt";

/// Computes the studies that `analysis` takes (`sweep`, `uncertainty`) in the folder `out`; collective. Parts that are done there are not
/// computed again, also those of a run that ended early or of a job array. Rank 0 gets the results, which are those of one process bit
/// for bit.
///
/// # Errors
/// Faults of the input, on rank 0; an error of this rank, whose process is to end then: that ends the others ([`World::abandon`]).
pub fn over_ranks(
    case: Result<Case>,
    analysis: &'static str,
    out: &Path,
    world: &Arc<World>,
    observer: &dyn Observer,
) -> Result<Option<RunResults>> {
    // What is wrong with the input is said once, by rank 0.
    let checked = case.and_then(|case| {
        let known = if world.rank() == 0 { parts_done(&case, analysis, out)? } else { None };
        Ok((case, known))
    });
    let mut valid = [u8::from(checked.is_ok())];
    world.broadcast(&mut valid)?;
    if valid == [0] {
        return if world.rank() == 0 { checked.map(|_| None) } else { Ok(None) };
    }
    let (case, known) = checked.map_err(|error| of_rank(world, error))?;
    let inputs = origin(&case).map_err(|error| of_rank(world, error))?;
    if let Some(rank) = first_that_differs(world, &format!("{inputs:?}"))? {
        let fault = Fault::new(
            "--engine mpi",
            format!("another case or other files on rank {rank}"),
            "those of rank 0",
        );
        return if world.rank() == 0 { Err(Error::input(fault)) } else { Ok(None) };
    }
    let mut of = [known.as_ref().map_or(PARTS_FOR_A_RANK * world.size(), |(of, _)| *of) as u64];
    world.broadcast(&mut of)?;
    let of = of[0] as usize;
    let list = parts_folder(out, analysis).join(LIST);
    if world.rank() == 0 {
        let done = known.map(|(_, done)| done).unwrap_or_default();
        for (rank, number) in earlier(&list).into_iter().filter(|(_, number)| !done.contains(number)) {
            observer.note(&format!(
                "An earlier run ended while rank {rank} computed part {number} of {of}, which is resumed"
            ));
        }
        let _ = std::fs::remove_file(&list);
    }
    let deal = Deal::new(world, of, Arc::new(note_in(&list)));
    let computed = run_parts((&case, analysis), of, &mut || Ok(deal.next()?.map(|k| k + 1)), out, observer);
    computed.map_err(|error| of_rank(world, error))?;
    deal.end().map_err(|error| of_rank(world, error))?;
    if world.rank() > 0 {
        return Ok(None);
    }
    let results = merge_parts(&case, analysis, out, Some(world.size()), observer)?;
    let _ = std::fs::remove_file(&list);
    Ok(Some(results))
}

/// An error of this rank alone, with its number: the others would wait for it at the common end.
fn of_rank(world: &World, error: Error) -> Error {
    world.abandon();
    match error.while_computing() {
        Error::Analysis { what, found, help } if world.rank() > 0 => {
            Error::Analysis { what: format!("rank {}, {what}", world.rank()), found, help }
        }
        error => error,
    }
}

/// Adds a rank and the part that it got to the list, for the message after an early end: without it the run goes on all the same.
fn note_in(list: &Path) -> impl Fn(usize, usize) + Send + Sync + use<> {
    let list = list.to_path_buf();
    move |rank, k| {
        let _ = list.parent().map(std::fs::create_dir_all);
        let file = OpenOptions::new().create(true).append(true).open(&list);
        let _ = file.and_then(|mut file| writeln!(file, "{rank} {}", k + 1));
    }
}

/// Ranks and parts of an earlier list.
fn earlier(list: &Path) -> Vec<(usize, usize)> {
    let text = std::fs::read_to_string(list).unwrap_or_default();
    let entry = |line: &str| {
        let (rank, number) = line.split_once(' ')?;
        Some((rank.parse().ok()?, number.parse().ok()?))
    };
    text.lines().filter_map(entry).collect()
}
