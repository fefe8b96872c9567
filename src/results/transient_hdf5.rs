//! `/transient` of `results.h5`: one dataset a channel that grows as the run goes on, each piece flushed, so that a killed
//! run leaves what it had reached.

use super::hdf5::{Datasets, ResultsFile, attribute, describe, text_attribute};
use super::{Channel, TransientResult};
use crate::error::Result;
use ndarray::s;

/// Values that HDF5 stores together.
const CHUNK: usize = 4096;

impl ResultsFile {
    /// Begins a run in time: an empty dataset for each channel.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn begin_transient(&mut self, time_step: f64, channels: &[Channel]) -> Result<()> {
        self.stage(|root| {
            let group = root.create_group("transient")?;
            attribute(&group, "time_step", &time_step)?;
            attribute(&group, "complete", &false)?;
            for channel in channels {
                let dataset =
                    group.new_dataset::<f64>().shape(0..).chunk(CHUNK).create(channel.name.as_str())?;
                describe(&dataset, channel.unit, &channel.about)?;
            }
            Ok(())
        })?;
        self.take_place()
    }

    /// Adds the values of the channels from value `first` on.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn write_transient_rows(&mut self, first: usize, channels: &[Channel]) -> Result<()> {
        self.stage(|root| {
            let group = root.group("transient")?;
            for channel in channels {
                let dataset = group.dataset(&channel.name)?;
                dataset.resize(channel.values.len())?;
                dataset.write_slice(&channel.values[first..], s![first..channel.values.len()])?;
            }
            Ok(())
        })
    }

    /// Writes what the whole record says.
    ///
    /// # Errors
    /// The machine refuses.
    pub fn finish_transient(&mut self, result: &TransientResult) -> Result<()> {
        self.stage(|root| {
            let group = root.group("transient")?;
            text_attribute(&group, "scheme", &result.scheme)?;
            attribute(&group, "worst_energy_residual", &result.worst_residual)?;
            for of in &result.spectra {
                let channel = &result.channels[of.channel];
                let spectrum = Datasets(group.create_group(&format!("spectrum_{}", channel.name))?);
                attribute(&spectrum.0, "resolution_hz", &of.spectrum.resolution_hz)?;
                let story = "amplitude of the sine that gives each line; line k stands at k · resolution_hz";
                spectrum.list("amplitude", &of.spectrum.amplitude, channel.unit, story)?;
                let hz: Vec<f64> = of.peaks.iter().map(|p| p.frequency_hz).collect();
                spectrum.list("peak_frequency_hz", &hz, "Hz", "its peaks")?;
                let height: Vec<f64> = of.peaks.iter().map(|p| p.amplitude).collect();
                spectrum.list("peak_amplitude", &height, channel.unit, "their amplitudes")?;
            }
            super::sound_hdf5::write(&group, result)?;
            group.attr("complete")?.write_scalar(&true)
        })
    }
}
