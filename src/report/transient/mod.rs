//! Motion in time: pictures of the histories, their spectra and spectrograms, the orbit, the contact and the sound; and
//! the tables.

mod contact;
mod finding;
mod history;
mod orbit;
mod raster;
mod sound;
mod spectra;
mod spectrogram;
mod table;

use super::player::player;
use super::reduced_check;
use super::section::{Display, ReportSection};
use crate::results::{ComplexResult, RunResults, TransientResult};

/// Motion in time, where the run has it.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let Some(run) = results.get::<TransientResult>() else { return Vec::new() };
    let complex = results.get::<ComplexResult>();
    let pictures = [
        history::picture(results),
        spectra::picture(results),
        spectrogram::picture(results),
        orbit::picture(results),
        contact::picture(results),
        sound::picture(results),
    ];
    let check = run.reduced_check.as_ref().map(|check| reduced_check::table(check, complex));
    let section = ReportSection::new("Motion in time")
        .findings([finding::motion(run)])
        .findings(finding::sound(run))
        .pictures(pictures.into_iter().flatten())
        .markup(run.sound.as_ref().and_then(player))
        .tables(Display::Titled, [table::table(run)])
        .tables(Display::Titled, sound::table(run))
        .tables(Display::Titled, check);
    vec![section]
}
