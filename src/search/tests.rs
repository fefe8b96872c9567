use super::*;
use crate::bounds::{Origin::*, within};
use std::path::PathBuf;

/// A folder with Hoffmann's two masses as case.toml and a search for its springs; the facts are its two frequencies.
fn folder(numbers: &str, facts: &str) -> (tempfile::TempDir, PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("case.toml"), include_str!("../../validation/hoffmann/case.toml"))
        .unwrap();
    let path = dir.path().join("search.toml");
    let text = format!("title = \"t\"\nsource = \"s\"\nevaluations = 600\n{numbers}{facts}");
    std::fs::write(&path, text).unwrap();
    (dir, path)
}

const NUMBERS: &str = "[parameter.k1]\npath = \"spring.k1.stiffness\"\nbetween = [\"5 N/m\", \"30 N/m\"]\n\
                       [parameter.k2]\npath = \"spring.k2.stiffness\"\nbetween = [\"5 N/m\", \"30 N/m\"]\nlog = true\n";

/// The two frequencies, without friction, of other springs: K x = ω² x of the block with m = 1 kg by hand.
fn facts(k1: f64, k2: f64) -> String {
    let (c, s) = (0.75, 0.25);
    let (k11, k12, k22) = (c * (k1 + k2), 3f64.sqrt() / 4.0 * (k2 - k1), s * (k1 + k2) + 11.0);
    let (mean, half) = (0.5 * (k11 + k22), (0.25 * (k11 - k22).powi(2) + k12 * k12).sqrt());
    let fact = |(k, square): (usize, f64)| {
        let hz = square.sqrt() / std::f64::consts::TAU;
        format!(
            "[fact.f{k}]\nkind = \"value\"\npointer = \"/cea/eigenvalues/{k}/frequency_hz\"\nreference = {hz}\n\
             tolerance = 1e-3\nset = {{ \"contact.belt.friction.mu0\" = 0 }}\n"
        )
    };
    [mean - half, mean + half].into_iter().enumerate().map(fact).collect()
}

#[test]
fn springs_are_found_whatever_the_threads_and_after_an_interruption() {
    let (dir, path) = folder(NUMBERS, &facts(14.0, 23.0));
    let file = read_search(&path).unwrap();
    let run = |name: &str, threads: usize, resume: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| search(&file, &dir.path().join(name), resume, &()).unwrap())
    };
    let whole = run("whole", 1, false);
    let values = |result: &SearchResult| result.numbers.iter().map(|n| n.after).collect::<Vec<_>>();
    assert!(
        whole.facts.rows.iter().all(|row| within(row.difference(), 1e-5, Tolerance)),
        "{:?}",
        whole.facts
    );
    // Two frequencies do not determine which of the springs is which: the sum and the difference of them do.
    let [k1, k2] = [values(&whole)[0], values(&whole)[1]];
    assert!(
        within((k1 + k2 - 37.0).abs(), 1e-2, Tolerance)
            && within(((k2 - k1).abs() - 9.0).abs(), 1e-1, Tolerance),
        "{k1} {k2}"
    );
    assert!(within(whole.costs[1], 1e-3, Tolerance) && whole.costs[0] > 10.0 && whole.without_answer == 0);
    assert!(whole.numbers.iter().all(|n| n.weight(whole.costs[1]) > 1.0 && !n.at_bound()));
    assert_eq!(values(&run("three", 3, false)), values(&whole));

    // Evaluations of an interrupted search are kept aside, and not resumed when a file has changed.
    let interrupted = dir.path().join("three");
    let origin = file.origin().unwrap();
    crate::results::record::keep_origin(&interrupted, &origin, false).unwrap();
    run("three", 3, false);
    assert!(interrupted.join("interrupted-1/search.csv").exists() && interrupted.join("search.csv").exists());
    let case = std::fs::read_to_string(dir.path().join("case.toml")).unwrap();
    std::fs::write(dir.path().join("case.toml"), case.replace("mu0 = 0.3", "mu0 = 0.31")).unwrap();
    let changed = read_search(&path).unwrap();
    let error = search(&changed, &interrupted, true, &()).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().contains("mu0` was"), "{error}");
    std::fs::write(dir.path().join("case.toml"), case).unwrap();

    let log = |name: &str| dir.path().join(name).join("search.csv");
    let rows = std::fs::read_to_string(log("whole")).unwrap();
    std::fs::create_dir(dir.path().join("killed")).unwrap();
    let half: Vec<&str> = rows.lines().take(rows.lines().count() / 2).collect();
    std::fs::write(log("killed"), half.join("\n") + "\n").unwrap();
    assert_eq!(values(&run("killed", 2, true)), values(&whole));
    assert_eq!(std::fs::read_to_string(log("killed")).unwrap(), rows);

    whole.write(dir.path()).unwrap();
    let found = crate::case::read_case(&dir.path().join("found.toml")).unwrap();
    assert_eq!(found.parameter("spring.k1.stiffness").unwrap().value, k1);
    let summary = std::fs::read_to_string(dir.path().join("search.json")).unwrap();
    assert!(summary.contains("\"met\": true"));
}

#[test]
fn a_log_of_another_search_is_refused_and_kept() {
    let (dir, path) = folder(NUMBERS, &facts(14.0, 23.0));
    let file = read_search(&path).unwrap();
    for (text, found) in [
        ("cost,other\n1,2\n", "another search"),
        ("", "another search"),
        ("HEAD\n1,x\n", "no number"),
        ("HEAD\n1\n", "1 cells"),
    ] {
        let heading = "cost,k1,k2,f0,f1";
        let text = text.replace("HEAD", heading);
        std::fs::write(dir.path().join("search.csv"), &text).unwrap();
        let error = search(&file, dir.path(), true, &()).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(found), "{error}");
        assert_eq!(std::fs::read_to_string(dir.path().join("search.csv")).unwrap(), text);
    }
}

/// What is only found once evaluations are written is no error of the input; a scalar in two parameters, or twice in one, is.
#[test]
fn faults_of_evaluations_are_no_faults_of_the_input() {
    for pointer in ["/cea/eigenvalues/0/growth", "/cea/eigenvalues/77/frequency_hz", "/none", ""] {
        let fact =
            format!("[fact.b]\nkind = \"value\"\npointer = \"{pointer}\"\nreference = 1\ntolerance = 0.1\n");
        let (dir, path) = folder(NUMBERS, &fact);
        match read_search(&path) {
            // Nothing is written.
            Err(error) => assert_eq!(error.exit_code(), 2),
            Ok(file) => {
                let error = search(&file, &dir.path().join("out"), false, &()).unwrap_err();
                assert_eq!(error.exit_code(), 1, "{pointer}: {error}");
            }
        }
    }
    for (first, second) in [
        ("\"a\"", "\"a\""),
        ("[\"a\", \"b\"]", "\"b\""),
        ("\"b\"", "[\"a\", \"b\"]"),
        ("\"b\"", "[\"a\", \"a\"]"),
    ] {
        let parameter = |name: &str, path: &str| {
            let path =
                path.replace("\"a\"", "\"spring.k1.stiffness\"").replace("\"b\"", "\"spring.k2.stiffness\"");
            format!("[parameter.{name}]\npath = {path}\nbetween = [\"5 N/m\", \"60 N/m\"]\n")
        };
        let (_dir, path) = folder(&(parameter("x", first) + &parameter("y", second)), &facts(14.0, 23.0));
        let error = read_search(&path).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("moves already"), "{error}");
    }
}

#[test]
fn every_fault_of_the_file_is_told() {
    let (_dir, path) = folder(
        "spread = 2\n[parameter.a]\npath = \"spring.k3.stiffness\"\nbetween = [1, 2]\n\
         [parameter.b]\npath = \"spring.k1.stiffness\"\nbetween = [\"50 N/m\", \"60 N/m\"]\n\
         [parameter.c]\npath = [\"spring.k1.stiffness\", \"spring.k2.stiffness\"]\nbetween = [\"5 N/m\", \"60 N/m\"]\n",
        "[fact.a]\nkind = \"peek\"\nreference = 1\ntolerance = 0.1\n[fact.b]\nkind = \"growth_rate\"\ntolerence = 1\n\
         [fact.c]\nkind = \"growth_rate\"\nreference = { kind = \"growth_rate\" }\ntolerance = 0.1\n",
    );
    let error = read_search(&path).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let error = error.to_string();
    for words in ["spread", "Did you mean `spring.k", "peek", "tolerence", "neither", "what is searched for"]
    {
        assert!(error.contains(words), "{words} not in\n{error}");
    }
    let (_dir, path) = folder(
        "[parameter.b]\npath = \"spring.k1.stiffness\"\nbetween = [\"50 N/m\", \"60 N/m\"]\n\
         [parameter.c]\npath = [\"mass.block.mass\"]\nbetween = [\"0.5 kg\", \"2 kg\"]\n\
         [parameter.d]\npath = [\"spring.k1.stiffness\", \"spring.k2.stiffness\"]\nbetween = [\"5 N/m\", \"60 N/m\"]\n",
        "[fact.a]\nkind = \"growth_rate\"\nreference = 1\ntolerance = 0.1\n[fact.b]\ncase = \"none.toml\"\n\
         kind = \"growth_rate\"\nreference = 1\ntolerance = 0.1\n",
    );
    let error = read_search(&path).unwrap_err().to_string();
    for words in ["without the case's own value 11", "scalars of one value", "none.toml"] {
        assert!(error.contains(words), "{words} not in\n{error}");
    }
    let (dir, path) = folder("", "");
    let error = read_search(&path).unwrap_err().to_string();
    assert!(error.contains("[parameter.NAME]") && error.contains("[fact.NAME]"), "{error}");
    std::fs::remove_file(dir.path().join("case.toml")).unwrap();
    assert!(read_search(&path).unwrap_err().to_string().contains("case.toml"));
    assert!(read_search(&dir.path().join("none.toml")).unwrap_err().to_string().contains("none.toml"));
}
