//! Where the keys of a case stand in its file, for faults that are found only with the mesh.

use std::collections::BTreeMap;
use stridor_base::error::{Error, Fault, Faults};

/// Where the keys of a case stand in its file. Two of them are always equal: a case is what it says, not where.
#[derive(Debug, Clone, Default)]
pub struct Places {
    pub(super) file: String,
    /// The text of the file, as it was read.
    pub(super) text: String,
    /// The line of each key, by its path.
    pub(super) lines: BTreeMap<String, usize>,
}

impl PartialEq for Places {
    fn eq(&self, _: &Places) -> bool {
        true
    }
}

impl Places {
    /// Name and text of the file; empty of a case that was no file.
    pub fn source(&self) -> (&str, &str) {
        (&self.file, &self.text)
    }

    /// With the text of the file.
    #[must_use]
    pub fn of_text(self, text: &str) -> Self {
        Places { text: text.into(), ..self }
    }

    /// The same error; faults whose place begins with a key in back-ticks get file and line before it, in the order of
    /// the lines.
    pub fn locate(&self, error: Error) -> Error {
        let Error::Input(Faults(faults)) = error else { return error };
        let mut located: Vec<(usize, Fault)> =
            faults.into_iter().map(|fault| self.with_line(fault)).collect();
        located.sort_by_key(|(line, _)| *line);
        Error::Input(Faults(located.into_iter().map(|(_, fault)| fault).collect()))
    }

    /// The same faults, as [`Places::locate`] gives them.
    pub fn located(&self, faults: Vec<Fault>) -> Vec<Fault> {
        match self.locate(Error::Input(Faults(faults))) {
            Error::Input(Faults(located)) => located,
            _ => Vec::new(),
        }
    }

    pub(super) fn with_line(&self, fault: Fault) -> (usize, Fault) {
        let key = fault.place.strip_prefix('`').and_then(|rest| rest.split('`').next());
        let Some(key) = key.filter(|_| !self.file.is_empty()) else { return (0, fault) };
        let mut path = key;
        let line = loop {
            match (self.lines.get(path), path.rsplit_once('.')) {
                (Some(line), _) => break Some(*line),
                (None, Some((parent, _))) => path = parent,
                (None, None) => break None,
            }
        };
        let line_of = line.map_or(String::new(), |line| format!(":{line}"));
        let place = format!("{}{line_of} {}", self.file, fault.place);
        (line.unwrap_or(0), Fault { place, ..fault })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_of_keys_get_their_lines_and_come_in_their_order() {
        let lines = [("force.a.on", 9), ("force.a", 8), ("force", 8), ("mesh", 2)];
        let lines = lines.map(|(key, line)| (key.to_string(), line)).into();
        let places = Places { file: "a.toml".into(), lines, ..Places::default() };
        let fault = |place: &str| Fault::new(place, "x", "y");
        let faults = ["`force.a.on.0`", "`mesh.rig.size`", "`frf.b`", "a.msh:3"].map(fault).to_vec();
        let Error::Input(located) = places.locate(Error::Input(Faults(faults))) else { panic!() };
        let all: Vec<&str> = located.0.iter().map(|fault| fault.place.as_str()).collect();
        assert_eq!(all, ["a.toml `frf.b`", "a.msh:3", "a.toml:2 `mesh.rig.size`", "a.toml:9 `force.a.on.0`"]);
        // Once is enough, and a case that was no file has no lines.
        assert_eq!(
            places.locate(Error::Input(located.clone())).to_string(),
            Error::Input(located).to_string()
        );
        let error = Places::default().locate(Error::input(fault("`mesh`"))).to_string();
        assert!(error.starts_with("`mesh`: found"), "{error}");
    }
}
