//! A player for the sound of a run, on the page.

use super::html::escape;
use crate::results::Sound;
use crate::sound::wav;
use base64::prelude::{BASE64_STANDARD, Engine};

/// A larger WAV file is not copied into the page: the player takes the file beside it \[bytes\], 31 s.
const LIMIT: usize = 3_000_000;
/// A shorter sound is repeated \[s\].
const SHORT: f64 = 2.0;

/// The recording at the first microphone; `None` where there is none.
pub(super) fn player(sound: &Sound) -> Option<String> {
    let first = sound.microphones.first()?;
    let record = &sound.recording;
    let bytes = wav(&record.pressure, record.rate, record.full_scale(), "");
    let file = format!("sound_{}.wav", first.name);
    let within = bytes.len() <= LIMIT;
    let source = if within {
        format!("data:audio/wav;base64,{}", BASE64_STANDARD.encode(&bytes))
    } else {
        escape(&file)
    };
    let seconds = record.pressure.len() as f64 / f64::from(record.rate);
    let (repeated, again) = if seconds < SHORT { (" loop", ", repeated") } else { ("", "") };
    let beside = if within { "the same" } else { "it plays from the file beside this page" };
    Some(format!(
        "<figure><audio controls preload=\"metadata\"{repeated} src=\"{source}\" style=\"width:100%;max-width:34rem\"></audio>\
         <figcaption>The sound at microphone {}: {seconds:.2} s of pressure, normalised to its peak{again}. \
         <a href=\"{}\">{}</a>: {beside}.</figcaption></figure>\n",
        escape(&first.name),
        escape(&file),
        escape(&file)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{TransientResult, sample};

    #[test]
    fn a_short_sound_is_in_the_page_and_a_long_one_beside_it() {
        let mut results = sample::rig();
        let sound = results.get_mut::<TransientResult>().unwrap().sound.as_mut().unwrap();
        let html = player(sound).unwrap();
        // RIFF as base64.
        assert!(
            html.contains("src=\"data:audio/wav;base64,UklGR")
                && html.contains(" loop")
                && html.contains("href=\"sound_axis.wav\"")
        );
        sound.recording.pressure = vec![0.1; LIMIT / 2];
        sound.microphones[0].name = "<b>\"".into();
        let html = player(sound).unwrap();
        assert!(
            html.contains("src=\"sound_&lt;b&gt;&quot;.wav\"")
                && !html.contains(" loop")
                && !html.contains("<b>")
        );
        sound.microphones.clear();
        assert!(player(sound).is_none());
    }
}
