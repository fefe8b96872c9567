//! Sound pressure as a WAV file.

/// The bytes of a WAV file, mono, 16 bits linear: a pressure of `full_scale` is the largest number, what is beyond it is
/// cut. `comment` goes into the file's list of information (RIFF `INFO`, `ICMT`).
///
/// IBM & Microsoft, *Multimedia Programming Interface and Data Specifications 1.0* (1991).
pub fn wav(pressure: &[f64], rate: u32, full_scale: f64, comment: &str) -> Vec<u8> {
    let sample = |p: &f64| {
        let scaled = (p / full_scale * f64::from(i16::MAX)).round();
        if scaled.is_finite() { scaled.clamp(-f64::from(i16::MAX), f64::from(i16::MAX)) as i16 } else { 0 }
    };
    let mut format = Vec::new();
    for field in [1u16, 1] {
        format.extend(field.to_le_bytes());
    }
    for field in [rate, 2 * rate] {
        format.extend(field.to_le_bytes());
    }
    for field in [2u16, 16] {
        format.extend(field.to_le_bytes());
    }
    let data: Vec<u8> = pressure.iter().flat_map(|p| sample(p).to_le_bytes()).collect();
    let mut words = comment.as_bytes().to_vec();
    words.push(0);
    let mut info = b"INFO".to_vec();
    chunk(&mut info, b"ICMT", &words);
    let mut body = b"WAVE".to_vec();
    chunk(&mut body, b"fmt ", &format);
    chunk(&mut body, b"data", &data);
    chunk(&mut body, b"LIST", &info);
    let mut file = Vec::with_capacity(body.len() + 8);
    chunk(&mut file, b"RIFF", &body);
    file
}

/// Name, length, content, and a zero to an even length.
fn chunk(out: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) {
    out.extend(name);
    out.extend((content.len() as u32).to_le_bytes());
    out.extend(content);
    if content.len() % 2 == 1 {
        out.push(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_follow_each_other_and_samples_read_back() {
        let pressure = [0.0, 0.25, -0.5, 1.0, f64::NAN];
        let file = wav(&pressure, 48_000, 0.5, "full scale 0.5 Pa");
        let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert!(&file[..4] == b"RIFF" && number(4) == file.len() - 8 && &file[8..12] == b"WAVE");
        let (mut at, mut seen) = (12, Vec::new());
        while at < file.len() {
            seen.push((file[at..at + 4].to_vec(), at + 8, number(at + 4)));
            at += 8 + number(at + 4).next_multiple_of(2);
        }
        assert_eq!(at, file.len());
        assert_eq!(seen.iter().map(|s| s.0.as_slice()).collect::<Vec<_>>(), [b"fmt ", b"data", b"LIST"]);
        let (_, data, length) = seen[1];
        let sample = |k: usize| i16::from_le_bytes(file[data + 2 * k..data + 2 * k + 2].try_into().unwrap());
        assert_eq!((0..length / 2).map(sample).collect::<Vec<_>>(), [0, 16384, -32767, 32767, 0]);
        assert_eq!(number(seen[0].1 + 4), 48_000);
        assert!(file.windows(17).any(|w| w == b"full scale 0.5 Pa"));
    }
}
