//! Contacts that run over the mesh of their counter-body in time.

use super::contacts::{Stand, surface_points};
use super::counter::counter_faces;
use super::prepared::Prepared;
use super::time_function::profile;
use crate::case::{Contact, SlidingChoice, TransientAnalysis};
use crate::contact::{Stations, mean_edge};
use crate::error::{Error, Fault, Faults, Result};
use crate::system::ContactPoint;
use crate::transient::Track;

/// The track of each pair of the case; none where the points stay.
///
/// # Errors
/// A way that leaves the counter-body.
pub fn tracks(prepared: &Prepared<'_>, wanted: &TransientAnalysis) -> Result<Vec<Option<Track>>> {
    let mut faults = Faults::new();
    let pairs = prepared.system.pairs.iter();
    let tracks = pairs.map(|pair| {
        let contact = &prepared.case.contact[&pair.name];
        let slides = wanted.slide.get(&pair.name).is_some_and(|slide| slide.travels);
        // A counter-body that turns keeps its place.
        let turns = matches!(contact.sliding, SlidingChoice::About { .. });
        if !slides || turns || contact.points.is_some() || contact.counter == "ground" {
            return None;
        }
        let course = wanted.slide.get(&pair.name).map(|slide| &slide.course);
        let factors = profile(course).reach(wanted.duration);
        let way = factors.map(|factor| factor * pair.sliding_velocity);
        let way = [way[0].min(way[1]), way[0].max(way[1])];
        faults.take(track(prepared, &pair.name, contact, &pair.points, way))
    });
    let tracks: Vec<_> = tracks.collect();
    faults.into_result(tracks)
}

/// The track of a pair from the least to the greatest travel \[m\].
fn track(
    prepared: &Prepared<'_>,
    name: &str,
    contact: &Contact,
    points: &[ContactPoint],
    [low, high]: [f64; 2],
) -> Result<Track> {
    let model = (&prepared.regions, &prepared.model, &*prepared.assembled.dofs);
    // The same gaps as where the pair stands, whatever was taken off them there.
    let touch = match contact.placement {
        Some(_) => {
            let bare = Stand { travel: 0.0, touch: Some(0.0) };
            let there = surface_points(name, contact, model, &bare)?;
            there.first().map_or(0.0, |p| p.gap) - points.first().map_or(0.0, |p| p.gap)
        }
        None => 0.0,
    };
    let at = |travel: f64| {
        let stand = Stand { travel, touch: Some(touch) };
        surface_points(name, contact, model, &stand).ok().filter(|there| there.len() == points.len())
    };
    let counter = counter_faces(
        &contact.counter,
        &prepared.regions,
        &prepared.model,
        (&format!("`contact.{name}.counter`"), ""),
    )?;
    let edge = mean_edge(&prepared.model.nodes, &counter.faces);
    let Stations { first, spacing, points } = Stations::new([low, high], edge, at).ok_or_else(|| {
        let found = format!("a way from {low:.4} m to {high:.4} m, which leaves `{}`", contact.counter);
        Error::input(
            Fault::new(format!("`transient.slide.{name}`"), found, "a path that stays on the counter-body")
                .with_help("Shorten the stroke or the run, or set `travels = false` to keep the contact in its place"),
        )
    })?;
    Ok(Track { first, spacing, stations: points })
}
