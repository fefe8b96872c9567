//! Which command is read by whom, and what commands that are not read mean.

use super::model::Selection;
use super::reader::{Command, Reader};
use crate::deck::Analysis;
use crate::ledger::Weight;

/// Commands that say nothing of vibrations: output, solution controls, heat, pictures; as far as their first four letters.
const SILENT: &str = "*DIM *ELS *END *GET *LIS *MSG *STA *TAX *TOP *VWR *CFO *DEL *PRE ACLE ANTY ARCL AUTO BF BFBL BFE BFK BFUN CDRE CDWR CEWR \
    CDOP CGLO CGOM CHEC CMWR CNCH CNKM CNTR CNVT CRPL CSCI DCGO DELT DESI DMPO DOF EMUN EQSL ERES ETCO EXTO FC FCUM FILE FINI HARF HROP IC IOPT IRLF \
    KBC KUSE LNSR LSSO LSWR LUMP MODC MONI MXPA NCNV NEQI NLDI NLGE NLHI NSUB NUMC NUMM NUMO OPNC OUTP OUTR PERB PRED PSTR QRDO RESC RESU \
    RSTS SAVE SCOP SECC SHPP SOLV SSTI STAB STAT STEF TBLI THOP TIME TIMI TINT TOFF TREF TRNO TSHA TUNI VCON WPST XMLO";

/// Commands that change the model and are not read.
const WEIGHTY: &[(&str, Weight, &str)] = &[
    ("*DO", Weight::Matters, "loops are not followed: what is in them is read once, or not at all"),
    ("*USE", Weight::Matters, "macros are not read"),
    ("*CRE", Weight::Matters, "macros are read as if they stood in the file"),
    ("*VRE", Weight::Matters, "tables of other files are not read"),
    ("*IF", Weight::Perhaps, "conditions are not evaluated: all branches are read"),
    ("/INP", Weight::Matters, "other files are not read"),
    ("INIS", Weight::Perhaps, "initial stresses"),
    ("PRET", Weight::Perhaps, "bolt pre-tension"),
    ("SLOA", Weight::Perhaps, "bolt pre-tension"),
    ("SECO", Weight::Perhaps, "offsets of shells and beams from their nodes"),
    ("SECM", Weight::Matters, "a section by a mesh of it"),
    ("SECJ", Weight::Matters, "joints"),
    ("SECL", Weight::Perhaps, "locks of joints"),
    ("EKIL", Weight::Matters, "elements without stiffness"),
    ("EALI", Weight::Matters, "elements without stiffness"),
    ("ESTI", Weight::Perhaps, "factors of killed elements"),
    ("CERO", Weight::Matters, "rotations of constraint equations"),
    ("CYCL", Weight::Matters, "cyclic symmetry"),
    ("CYCO", Weight::Matters, "cyclic symmetry"),
    ("CORI", Weight::Matters, "Coriolis forces: say so in the case"),
    ("CMAC", Weight::Perhaps, "accelerations of parts"),
    ("DOME", Weight::Perhaps, "angular accelerations"),
    ("DMPR", Weight::Perhaps, "a damping ratio of all modes"),
    ("MDAM", Weight::Perhaps, "damping ratios of modes"),
    ("EMOD", Weight::Matters, "changes of elements that are not read"),
    ("EORI", Weight::Matters, "turned elements"),
    ("ENOR", Weight::Matters, "turned elements"),
    ("NGEN", Weight::Matters, "copies of nodes"),
    ("EGEN", Weight::Matters, "copies of elements"),
    ("NROT", Weight::Matters, "turned frames of nodes"),
    ("NMOD", Weight::Matters, "changes of nodes"),
    ("SF", Weight::Perhaps, "pressures by nodes"),
    ("SFGR", Weight::Perhaps, "pressures that change over a face"),
    ("SE", Weight::Matters, "substructures"),
];

impl<'a> Reader<'a> {
    /// Reads a command with the lines that follow it.
    pub fn command(&mut self, command: &Command<'a>) {
        let name = command.name.as_str();
        // Letters beyond the fourth say nothing.
        let short: String = name.chars().take(4).collect();
        match short.as_str() {
            "NBLO" => self.nodes_block(command),
            "EBLO" => self.elements_block(command),
            "ETBL" => self.types_block(command),
            "RLBL" => self.reals_block(command),
            "CMBL" => self.component_block(command),
            "SECB" => self.section_block(command),
            "DBLO" => self.held_block(command),
            "SFEB" => self.pressures_block(command),
            "N" => self.one_node(command),
            "E" | "EN" => self.one_element(command),
            "ET" | "KEYO" | "TYPE" | "MAT" | "REAL" | "SECN" | "ESYS" | "R" | "RMOD" | "RMOR" | "SECT"
            | "SECD" | "LOCA" | "CS" | "CSYS" => self.attribute(command, &short),
            "MP" | "MPDA" | "MPTE" | "MPDE" | "UIMP" | "TB" | "TBDA" | "TBTE" | "TBFI" | "TBPT" | "TBIN" => {
                self.material(command, &short);
            }
            "ALPH" | "BETA" | "DMPS" => self.damping(command, &short),
            "D" => self.hold(command),
            "F" => self.force(command),
            "SFE" => self.surface_load(command),
            "CE" => self.equation(command),
            "CP" => self.coupled(command),
            "CERI" => self.region(command, true),
            "RBE3" => self.region(command, false),
            "ACEL" | "OMEG" | "CMOM" | "CMRO" => self.motion(command, &short),
            "MODO" => self.modes(command),
            "NSEL" => self.select(command, true),
            "ESEL" => self.select(command, false),
            "NSLE" => self.select_joined(command, true),
            "ESLN" => self.select_joined(command, false),
            "CMSE" => self.select_component(command),
            "ALLS" => {
                self.model.selected_nodes = Selection::All;
                self.model.selected_elements = Selection::All;
            }
            "CM" => self.component(command),
            "*SET" => self.assign(command.arg(0), command.arg(1), command.place),
            "/TIT" => self.model.title = command.args.join(","),
            "*IF" if command.word(0) == "_CDRDOFF" => {}
            _ => self.unread(command, &short),
        }
    }

    /// Notes a command that is not read; commands of numbers that are all zero say nothing.
    fn unread(&mut self, command: &Command<'_>, short: &str) {
        let (name, place) = (&command.name, command.place);
        let zero = |arg: &&str| self.value(arg) == Some(0.0);
        if matches!(short, "DOME" | "DMPR" | "CMAC") && command.args.iter().all(zero) {
            return;
        }
        let starts = |own: &str| short == own || (own.len() >= 3 && short.starts_with(own));
        if let Some((_, weight, why)) = WEIGHTY.iter().find(|(own, ..)| starts(own)) {
            self.note(*weight, name, *why, place);
        } else if SILENT.split_whitespace().any(starts) || short.starts_with('/') {
            self.note(Weight::Nothing, name, "output, solution or heat: not read", place);
        } else {
            self.note(Weight::Perhaps, name, "a command that is not known", place);
        }
    }

    /// CM: a component of what is selected.
    fn component(&mut self, command: &Command<'_>) {
        let of_nodes = match command.word(1).get(..4) {
            Some("NODE") => true,
            Some("ELEM") => false,
            _ => {
                let why = "a component of geometry: nodes and elements are read";
                return self.note(Weight::Nothing, "CM", why, command.place);
            }
        };
        let selected = self.model.selected(of_nodes);
        match selected.and_then(|selected| self.spend(command, selected, 0)) {
            Some(members) => {
                if !self.keep(command.place, members.len()) {
                    return;
                }
                let ranges = members.into_iter().map(|number| (number, number)).collect();
                let component = super::model::Component::new(command.arg(0), of_nodes, ranges, command.place);
                self.model.add_component(component);
            }
            None => {
                let why = "a component of a selection that is not known";
                self.note(Weight::Matters, format!("component {}", command.arg(0)), why, command.place);
            }
        }
    }

    /// MODOPT: Method, number of modes, from, to \[Hz\].
    fn modes(&mut self, command: &Command<'_>) {
        let count =
            self.value(command.arg(1)).filter(|count| (1.0..1e6).contains(count)).map(|count| count as usize);
        let band = [2, 3].map(|k| self.value(command.arg(k)).filter(|hz| *hz > 0.0));
        self.model.analyses.push(match command.word(0).as_str() {
            "UNSY" | "UNSYM" | "DAMP" | "QRDA" | "QRDAMP" => Analysis::ComplexModes { count, band },
            _ => Analysis::Modes { count, band },
        });
    }

    /// N: node, x, y, z, θxy, θyz, θzx; in archives also N,R5.3,LOC or ANG,node,….
    fn one_node(&mut self, command: &Command<'_>) {
        let form = command.word(0);
        let (at, angles) = match form.as_str() {
            "UNBL" => return,
            form if form.starts_with('R') && form.contains('.') => match command.word(1).as_str() {
                "LOC" => (2, false),
                "ANG" => (2, true),
                _ => return self.note(Weight::Matters, "N", "a form of it that is not known", command.place),
            },
            _ => (0, false),
        };
        let Some(number) = self.whole(command, at) else { return };
        if at == 2 && number < 0 {
            return;
        }
        let values: Option<Vec<f64>> = (at + 1..at + 7).map(|k| self.real(command, k)).collect();
        let Some(values) = values else { return };
        let three = |k: usize| [values[k], values[k + 1], values[k + 2]];
        if angles {
            _ = self.model.angles.insert(number.unsigned_abs(), three(0));
            return;
        }
        match self.placed(three(0)) {
            Some(position) => self.node(number, position, three(3), command.place),
            None => self.fault(
                command.place,
                format!("a node in coordinate system {}", self.model.system),
                "a Cartesian or a cylindrical system that is defined above",
            ),
        }
    }

    /// E: nodes; EN: number, nodes; both with the attributes of now.
    fn one_element(&mut self, command: &Command<'_>) {
        if command.word(0).starts_with("R5") || command.word(0).starts_with("UNBL") {
            if command.args.last() == Some(&"-1") {
                return;
            }
            let why =
                "elements in lines of their own: write the archive in blocks (CDWRITE with UNBLOCKED off)";
            return self.note(Weight::Matters, "EN", why, command.place);
        }
        let own = usize::from(command.name == "EN");
        let last = self.model.elements.keys().next_back().map_or(0, |last| *last as i64);
        let number = if own == 1 { self.whole(command, 0) } else { Some(last.saturating_add(1)) };
        let mut nodes: Vec<i64> = Vec::new();
        for k in own..command.args.len().min(own + 20) {
            match self.whole(command, k) {
                Some(node) => nodes.push(node),
                None => return,
            }
        }
        while self.peek().is_some_and(|line| line.trim_start().to_ascii_uppercase().starts_with("EMORE")) {
            let Some((line, place)) = self.line() else { break };
            let args: Vec<&str> =
                line.split('!').next().unwrap_or("").split(',').skip(1).map(str::trim).collect();
            let more = Command { name: "EMORE".into(), args, place };
            nodes.resize(8 * nodes.len().div_ceil(8).clamp(1, 4), 0);
            for k in 0..more.args.len().min(8) {
                match self.whole(&more, k) {
                    Some(node) => nodes.push(node),
                    None => return,
                }
            }
        }
        let now = self.model.current;
        let attributes = [now.kind, now.material, now.real, now.section, now.system].map(i64::from);
        if let Some(number) = number {
            self.element(number, attributes, &nodes, command.place);
        }
    }
}
