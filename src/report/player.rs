//! A player for the sound of a run, on the page.

use super::format::fixed;
use super::html::escape;
use crate::results::{MicrophoneSound, Sound};
use crate::sound::wav;
use base64::prelude::{BASE64_STANDARD, Engine};

/// WAV files that are larger together are not copied into the page: the player takes the files beside it \[bytes\], 31 s.
const LIMIT: usize = 3_000_000;
/// A shorter sound is repeated \[s\].
const SHORT: f64 = 2.0;

/// The recordings, the loudest microphone first; `None` where there is none.
pub(super) fn player(sound: &Sound) -> Option<String> {
    let mut microphones: Vec<&MicrophoneSound> = sound.microphones.iter().collect();
    microphones.sort_by(|a, b| b.levels()[1].total_cmp(&a.levels()[1]));
    let first = *microphones.first()?;
    // Samples of 16 bits.
    let within = microphones.iter().map(|m| 2 * m.recording.pressure.len()).sum::<usize>() <= LIMIT;
    let sources: Vec<String> = microphones.iter().map(|m| source(m, within)).collect();
    let option = |(microphone, source): (&&MicrophoneSound, &String)| {
        format!(
            "<option data-src=\"{source}\">{}: {} dB(A)</option>",
            escape(&microphone.name),
            fixed(microphone.levels()[1], 1)
        )
    };
    let options: String = microphones.iter().zip(&sources).map(option).collect();
    let choice = match microphones.len() {
        1 => String::new(),
        _ => format!(
            "<p><label>Microphone <select onchange=\"const a=this.closest('figure').querySelector('audio'),t=a.currentTime,on=!a.paused;\
             a.src=this.selectedOptions[0].dataset.src;a.currentTime=t;if(on)a.play()\">{options}</select></label></p>\n"
        ),
    };
    let seconds = first.recording.pressure.len() as f64 / f64::from(first.recording.rate);
    let (repeated, again) = if seconds < SHORT { (" loop", ", repeated") } else { ("", "") };
    let link = |m: &&MicrophoneSound| {
        let file = escape(&format!("sound_{}.wav", m.name));
        format!("<a href=\"{file}\">{file}</a>")
    };
    let links: Vec<String> = microphones.iter().map(link).collect();
    let at = match microphones.len() {
        1 => format!("at microphone {}", escape(&first.name)),
        _ => "at each microphone".into(),
    };
    let beside = if within { "The same" } else { "It plays from the files beside this page" };
    Some(format!(
        "<figure>{choice}<audio controls preload=\"metadata\"{repeated} src=\"{}\" style=\"width:100%;max-width:34rem\"></audio>\
         <figcaption>The sound {at}: {seconds:.2} s of pressure, normalised to its peak{again}. {beside}: {}.</figcaption></figure>\n",
        sources[0],
        links.join(", ")
    ))
}

/// Where a recording comes from: the page itself, or the file beside it.
fn source(microphone: &MicrophoneSound, within: bool) -> String {
    if !within {
        return escape(&format!("sound_{}.wav", microphone.name));
    }
    let record = &microphone.recording;
    let bytes = wav(&record.pressure, record.rate, record.full_scale(), "");
    format!("data:audio/wav;base64,{}", BASE64_STANDARD.encode(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::sample;
    use crate::results::TransientResult;

    #[test]
    fn every_microphone_can_be_chosen_and_the_loudest_comes_first() {
        let mut results = sample::rig();
        let sound = results.get_mut::<TransientResult>().unwrap().sound.as_mut().unwrap();
        let html = player(sound).unwrap();
        // RIFF as base64: the player, and two microphones to choose from.
        assert_eq!(html.matches("src=\"data:audio/wav;base64,UklGR").count(), 3);
        let at = |text: &str| html.find(text).unwrap_or_else(|| panic!("no {text}"));
        assert!(at(">side: ") < at(">axis: ") && html.contains(" dB(A)</option>"));
        assert!(html.contains("href=\"sound_axis.wav\"") && html.contains("href=\"sound_side.wav\""));
        sound.microphones.truncate(1);
        let html = player(sound).unwrap();
        assert!(!html.contains("<select") && html.contains("at microphone axis"));
    }

    #[test]
    fn a_short_sound_is_in_the_page_and_a_long_one_beside_it() {
        let mut results = sample::rig();
        let sound = results.get_mut::<TransientResult>().unwrap().sound.as_mut().unwrap();
        assert!(player(sound).unwrap().contains(" loop"));
        sound.microphones.truncate(1);
        sound.microphones[0].recording.pressure = vec![0.1; LIMIT / 2 + 1];
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
