//! The mode shapes, and the motion at the end of a run in time, on the page: a viewer in WebGL with the data it draws.
//!
//! A complex mode moves every node by u(t) = Re(φ e^{iωt}) = Re φ cos ωt − Im φ sin ωt, without its growth e^{σt}: an
//! ellipse in space, which nodes pass at different times (a travelling wave) unless φ is real but for a factor. A real
//! mode moves by φ cos ωt (a standing wave). Shapes have no size of their own: the largest displacement of a cycle is
//! shown as a chosen part of the model.
//!
//! A run in time moves them by the Fourier series of its last periods, u(t) = Re Σ_h U_h e^{2πi h f₀ t}
//! ([`CycleFields`](crate::results::CycleFields)): a field for each harmonic instead of one for each picture.
//!
//! * [`surface`]: faces, bars and points of the model, with fewer nodes where the page would become too large.
//! * [`field`]: displacements at their nodes, in 16 bits.
//! * `viewer.js` draws them, `viewer.html` and `viewer.css` are its controls.

mod field;
mod surface;

use super::colours::{PARTS, diverging, sequential};
use super::format::{given, hertz, prefixed, rate};
use super::html::{allowed, escape};
use super::section::ReportSection;
use super::view::View;
use crate::linalg::c64;
use crate::results::{ComplexResult, CycleFields, NamedModes, RunResults, TransientResult};
use crate::stability::ComplexMode;
use base64::prelude::{BASE64_STANDARD, Engine};
use field::{Motion, MotionInTime, encode};
use serde_json::{Value, json};
use surface::Surface;

/// The strongest of the unstable modes are shown, at most so many.
const MOST: usize = 24;
/// Where none is unstable, the modes nearest to it.
const NEAREST: usize = 6;
/// Real modes of a set, the lowest that are not rigid-body modes.
const REAL: usize = 12;
/// Size of the data of the complex modes and of the motion in time on a page at most \[bytes\]: with more, nodes are left out.
const LIMIT: usize = 4_000_000;
/// Real modes are added while all data is smaller than this \[bytes\].
const LIMIT_WITH_REAL: usize = 1_000_000;

/// The viewer, where the run has a mesh and modes or motion in time.
pub(super) fn sections(results: &RunResults) -> Vec<ReportSection> {
    let complex = results.get::<ComplexResult>();
    let chosen = complex.map_or(Vec::new(), |complex| chosen(&complex.modes.modes));
    let sets = results.all::<NamedModes>();
    let any_real = sets.iter().any(|set| set.modes.eigenvalues.len() > set.modes.rigid_bodies);
    let cycle = results.get::<TransientResult>().and_then(|run| run.cycle.as_ref());
    if results.geometry.elements.is_empty() || chosen.is_empty() && !any_real && cycle.is_none() {
        return Vec::new();
    }
    let fields = chosen.len() + cycle.map_or(0, |cycle| cycle.harmonics.len());
    let surface = Surface::within(&results.geometry, fields.max(1), LIMIT);
    let mut modes: Vec<Value> = chosen.iter().filter_map(|k| complex_mode(complex?, *k, &surface)).collect();
    let in_time = cycle.and_then(|cycle| motion_in_time(cycle, &surface));
    let first = if in_time.is_some() { modes.len() } else { strongest(complex, &chosen) };
    let mut size: usize = surface.encoded_size(fields);
    let moves = in_time.is_some();
    modes.extend(in_time);
    for set in sets {
        for k in set.modes.rigid_bodies..set.modes.eigenvalues.len().min(set.modes.rigid_bodies + REAL) {
            size += surface.encoded_field_size() / 2;
            if size < LIMIT_WITH_REAL || modes.is_empty() {
                modes.extend(real_mode(set, k, &surface));
            }
        }
    }
    if modes.is_empty() {
        return Vec::new();
    }
    let words = [
        (modes.len() > usize::from(moves)).then(|| modes_caption(results, chosen.len())),
        cycle.filter(|_| moves).map(caption_in_time),
        Some(drawn(chosen.len(), moves, &surface)),
    ];
    let words = words.into_iter().flatten().collect::<Vec<_>>().join(" ");
    let heading = if moves { "Motion in 3-D" } else { "Mode shapes in motion" };
    let section = ReportSection::new(heading).markup([viewer(&data(&surface, modes, first), &words)]);
    vec![section]
}

/// Indices of the unstable modes or, where there is none, of those nearest to it; ascending in frequency.
fn chosen(all: &[ComplexMode]) -> Vec<usize> {
    let mut modes: Vec<usize> = (0..all.len()).filter(|k| all[*k].growth_rate().is_finite()).collect();
    modes.sort_by(|a, b| all[*b].growth_rate().total_cmp(&all[*a].growth_rate()));
    let unstable = modes.iter().filter(|k| all[**k].unstable()).count();
    modes.truncate(if unstable > 0 { unstable.min(MOST) } else { NEAREST });
    modes.sort_by(|a, b| all[*a].frequency_hz().total_cmp(&all[*b].frequency_hz()));
    modes
}

/// The place among the chosen modes of the one that grows most.
fn strongest(complex: Option<&ComplexResult>, chosen: &[usize]) -> usize {
    let rate = |k: usize| complex.map_or(0.0, |c| c.modes.modes[k].growth_rate());
    (0..chosen.len()).max_by(|a, b| rate(chosen[*a]).total_cmp(&rate(chosen[*b]))).unwrap_or(0)
}

fn complex_mode(complex: &ComplexResult, k: usize, surface: &Surface) -> Option<Value> {
    let mode = &complex.modes.modes[k];
    let motion = Motion::new(&complex.shape(k), &surface.nodes)?;
    let unstable = if mode.unstable() { ", unstable" } else { "" };
    let name = format!(
        "mode {}: {} Hz, σ {} 1/s{unstable}",
        k + 1,
        hertz(mode.frequency_hz(), 1),
        rate(mode.eigenvalue)
    );
    Some(json!({
        "set": "complex modes",
        "name": name,
        "hz": mode.frequency_hz(),
        "begin": 0,
        "harmonics": [harmonic(&motion)],
    }))
}

/// The last period of a run in time.
fn motion_in_time(cycle: &CycleFields, surface: &Surface) -> Option<Value> {
    let motion = MotionInTime::new(cycle, &surface.nodes)?;
    let largest = prefixed(motion.largest, "m", 4);
    Some(json!({
        "set": "motion in time",
        "name": format!("last period, {} Hz: largest displacement {largest}", hertz(cycle.frequency_hz, 1)),
        "hz": cycle.frequency_hz,
        "begin": motion.begin,
        "harmonics": motion.harmonics.iter().map(harmonic).collect::<Vec<_>>(),
    }))
}

fn harmonic(motion: &Motion) -> Value {
    json!({ "re": encode(&motion.re), "im": encode(&motion.im) })
}

fn real_mode(set: &NamedModes, k: usize, surface: &Surface) -> Option<Value> {
    let shape: Vec<[c64; 6]> = set.shape(k).iter().map(|u| u.map(|c| c64::new(c, 0.0))).collect();
    let motion = Motion::new(&shape, &surface.nodes)?;
    let figure = set.names.get(k).copied().flatten();
    let figure = figure.map_or(String::new(), |n| format!(" ({}, {})", n.nodal_diameters, n.nodal_circles));
    let hz = set.modes.frequency_hz(k);
    Some(json!({
        "set": format!("real modes: {}", allowed(&set.name)),
        "name": format!("mode {}: {} Hz{figure}", k + 1, hertz(hz, 1)),
        "hz": hz,
        "begin": 0,
        "harmonics": [{ "re": encode(&motion.re) }],
    }))
}

/// Everything that the viewer draws.
fn data(surface: &Surface, modes: Vec<Value>, first: usize) -> Value {
    let view = View::facing([0.68, -0.85, 0.55]).expect("a direction");
    let stops = |of: &dyn Fn(f64) -> String| (0..5).map(|k| of(f64::from(k) / 4.0)).collect::<Vec<_>>();
    json!({
        "view": [view.right, view.up, view.towards],
        "places": encode(&surface.places()),
        "normals": BASE64_STANDARD.encode(surface.normals().iter().map(|c| (127.0 * c).round() as i8 as u8).collect::<Vec<_>>()),
        "parts": surface.parts.iter().enumerate().map(|(k, part)| json!({
            "name": allowed(&part.name),
            "colour": PARTS[k % PARTS.len()][0],
            "faces": indices(&part.faces),
            "bars": indices(&part.bars),
            "points": indices(&part.points),
        })).collect::<Vec<_>>(),
        "diverging": stops(&|t| diverging(2.0 * t - 1.0)),
        "sequential": stops(&sequential),
        "first": first,
        "modes": modes,
    })
}

/// Indices of nodes, 32 bits each.
fn indices<const N: usize>(corners: &[[u32; N]]) -> String {
    BASE64_STANDARD.encode(corners.iter().flatten().flat_map(|k| k.to_le_bytes()).collect::<Vec<_>>())
}

/// The controls, the data and the script.
fn viewer(data: &Value, caption: &str) -> String {
    // Within a script element only `<` could end it.
    let data = data.to_string().replace('<', "\\u003c");
    format!(
        "<style>{}</style>\n<figure id=\"shapes\">\n{}<figcaption>{}</figcaption></figure>\n<script type=\"application/json\" id=\"shapes-data\">{data}</script>\n<script>{}</script>\n",
        include_str!("viewer.css"),
        include_str!("viewer.html"),
        escape(caption),
        include_str!("viewer.js")
    )
}

fn modes_caption(results: &RunResults, shown: usize) -> String {
    let complex = results.get::<ComplexResult>().map_or(&[][..], |complex| &complex.modes.modes);
    let unstable = complex.iter().filter(|mode| mode.unstable()).count();
    let which = match (unstable, shown) {
        (0, 0) => "Real modes".to_string(),
        (0, n) => format!("None is unstable: the {n} complex modes that die away most slowly"),
        (all, n) if n < all => format!("The {n} strongest of {all} unstable modes"),
        (1, _) => "The unstable mode".into(),
        _ => "Every unstable mode".into(),
    };
    format!("{which}, u(t) = Re(φ e^(iωt)) at constant amplitude and slowed down.")
}

fn caption_in_time(cycle: &CycleFields) -> String {
    let [begin, end] = cycle.window.map(given);
    let harmonics = match cycle.harmonics.len() {
        1 => String::new(),
        n => format!(", h = 1 to {n}"),
    };
    format!(
        "Motion in time about its mean, u(t) = Re Σ U_h e^(2πi h f₀ t) with f₀ = {} Hz{harmonics}, from the steps between {begin} and {end} s; \
         motion that is not periodic with f₀ is left out.",
        hertz(cycle.frequency_hz, 1)
    )
}

/// How the motion is drawn, and the files that have the whole of it.
fn drawn(complex: usize, in_time: bool, surface: &Surface) -> String {
    let file = match (complex, in_time) {
        (0, true) => "results.h5",
        (0, false) => "modes_<set>.vtu",
        (_, true) => "complex_modes.vtu and results.h5",
        (_, false) => "complex_modes.vtu",
    };
    let files = match surface.nodes.len() {
        n if n < surface.all_nodes => {
            format!("Shown with {n} of {} nodes; all of them are in {file}.", surface.all_nodes)
        }
        _ => format!("The same in full precision: {file}."),
    };
    format!(
        "The displacement is enlarged. Normal displacement: along the normal of the surface at rest. {files}"
    )
}

#[cfg(test)]
mod tests {
    use super::super::section::Item;
    use super::*;
    use crate::bounds::{Origin::*, within};
    use crate::job::sample;

    fn markup(results: &RunResults) -> String {
        let sections = sections(results);
        let Some(Item::Markup(html)) = sections[0].items.first() else { panic!("no viewer") };
        html.clone()
    }

    fn shown(html: &str) -> Value {
        let data = html.split("id=\"shapes-data\">").nth(1).unwrap().split("</script>").next().unwrap();
        serde_json::from_str(data).unwrap()
    }

    #[test]
    fn every_unstable_mode_moves_and_the_strongest_comes_first() {
        let mut results = sample::rig();
        results.get_mut::<TransientResult>().unwrap().cycle = None;
        let data = shown(&markup(&results));
        let names: Vec<&str> =
            data["modes"].as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
        assert!(
            names[0].contains("276.3 Hz") && names[1].contains("331.9 Hz") && names[2].contains("569.2 Hz")
        );
        assert!(names[..3].iter().all(|name| name.ends_with("unstable")) && !names[3].contains("unstable"));
        assert_eq!(data["first"], 1);
        assert_eq!(data["modes"][3]["set"], "real modes: disc");
        let im = |mode: usize| &data["modes"][mode]["harmonics"][0]["im"];
        assert!(im(0).is_string() && im(3).is_null());
        assert_eq!(data["parts"].as_array().unwrap().len(), 3);
    }

    #[test]
    fn motion_in_time_is_shown_first_with_its_harmonics_and_its_time() {
        let mut results = sample::rig();
        let node =
            |size: f64| vec![[c64::new(size, 0.0), c64::ZERO, c64::ZERO]; results.geometry.nodes.len()];
        let cycle = CycleFields {
            frequency_hz: 1668.0,
            window: [0.07, 0.08],
            harmonics: vec![node(2e-6), node(1e-8)],
        };
        results.get_mut::<TransientResult>().unwrap().cycle = Some(cycle);
        let data = shown(&markup(&results));
        let mode = &data["modes"][data["first"].as_u64().unwrap() as usize];
        assert!(
            mode["set"] == "motion in time" && mode["harmonics"].as_array().unwrap().len() == 2,
            "{mode}"
        );
        assert!(within((mode["begin"].as_f64().unwrap() - (0.08 - 1.0 / 1668.0)).abs(), 1e-12, RoundOff));
        assert!(mode["name"].as_str().unwrap().contains("1668.0 Hz: largest displacement 2.0"), "{mode}");
        // Without a mode it is there alone.
        results.take::<ComplexResult>();
        while results.take::<NamedModes>().is_some() {}
        assert_eq!(shown(&markup(&results))["modes"].as_array().unwrap().len(), 1);
    }

    #[test]
    fn without_an_unstable_mode_the_nearest_are_there() {
        let mut results = sample::rig();
        let modes = &mut results.get_mut::<ComplexResult>().unwrap().modes.modes;
        modes.iter_mut().for_each(|m| m.eigenvalue.re -= 1000.0);
        let data = shown(&markup(&results));
        let complex =
            data["modes"].as_array().unwrap().iter().filter(|m| m["set"] == "complex modes").count();
        assert_eq!(complex, NEAREST);
    }

    #[test]
    fn names_of_parts_cannot_end_the_script() {
        let mut results = sample::rig();
        results.geometry.parts[0] = "</script><script>alert(1)</script>".into();
        results.get_mut::<NamedModes>().unwrap().name = "<!--<script>".into();
        let html = markup(&results);
        assert_eq!((html.matches("<script").count(), html.matches("</script").count()), (2, 2));
        assert!(
            !html.contains("<!--")
                && shown(&html)["parts"][0]["name"] == "</script><script>alert(1)</script>"
        );
    }

    #[test]
    fn a_run_without_a_mesh_or_modes_has_no_viewer() {
        let mut results = sample::rig();
        results.geometry.elements.clear();
        assert!(sections(&results).is_empty());
        assert!(sections(&RunResults { geometry: sample::rig().geometry, ..Default::default() }).is_empty());
    }
}
