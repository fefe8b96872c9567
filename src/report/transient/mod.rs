//! Motion in time: pictures of the histories, their spectra and spectrograms, the orbit, the contact and the sound; and
//! the tables.

mod contact;
mod history;
mod orbit;
mod raster;
mod sound;
mod spectra;
mod spectrogram;
mod table;

use super::html::Picture;
use crate::results::RunResults;

pub(super) use sound::table as sound_table;
pub(super) use table::table;

/// Files of the pictures, in the order of the page.
pub(super) const FILES: [&str; 6] = [
    "transient.svg",
    "transient_spectrum.svg",
    "transient_spectrogram.svg",
    "transient_phase.svg",
    "transient_contact.svg",
    "sound.svg",
];

/// The pictures that the run has something for.
pub(super) fn pictures(results: &RunResults) -> Vec<Picture> {
    let all = [
        history::picture(results),
        spectra::picture(results),
        spectrogram::picture(results),
        orbit::picture(results),
        contact::picture(results),
        sound::picture(results),
    ];
    all.into_iter().flatten().collect()
}
