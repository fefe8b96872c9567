//! A field of colours as a picture inside an SVG sheet.

use base64::prelude::{BASE64_STANDARD, Engine};

/// Colours of the palette.
const SHADES: usize = 128;

/// An `<image>` at a rectangle of pixels (left, top, width, height): `cells` in \[0, 1\] row by row from the top, each
/// `across` long, shown in the colours (`#rrggbb`) of `shade`.
pub(super) fn image(
    [x, y, width, height]: [f64; 4],
    across: usize,
    cells: &[f64],
    shade: impl Fn(f64) -> String,
) -> String {
    let png = png(across, cells, shade);
    format!(
        "<image x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" preserveAspectRatio=\"none\" \
         href=\"data:image/png;base64,{}\"/>\n",
        BASE64_STANDARD.encode(&png)
    )
}

/// A PNG of 8-bit palette colours (ISO/IEC 15948), its data in stored blocks of deflate (RFC 1950, 1951): nothing is
/// squeezed, and no library is needed.
fn png(across: usize, cells: &[f64], shade: impl Fn(f64) -> String) -> Vec<u8> {
    let across = across.max(1);
    let rows = cells.len() / across;
    let mut lines = Vec::with_capacity(cells.len() + rows);
    for row in cells.chunks_exact(across) {
        lines.push(0);
        lines.extend(row.iter().map(|v| (v.clamp(0.0, 1.0) * (SHADES - 1) as f64).round() as u8));
    }
    let mut data = vec![0x78, 0x01];
    let blocks = lines.len().div_ceil(0xffff);
    for (k, block) in lines.chunks(0xffff).enumerate() {
        data.push(u8::from(k + 1 == blocks));
        data.extend((block.len() as u16).to_le_bytes());
        data.extend((!(block.len() as u16)).to_le_bytes());
        data.extend(block);
    }
    data.extend(adler(&lines).to_be_bytes());
    let mut header = Vec::new();
    header.extend((across as u32).to_be_bytes());
    header.extend((rows as u32).to_be_bytes());
    header.extend([8, 3, 0, 0, 0]);
    let palette: Vec<u8> = (0..SHADES)
        .flat_map(|k| {
            let hex = shade(k as f64 / (SHADES - 1) as f64);
            [1, 3, 5]
                .map(|at| hex.get(at..at + 2).and_then(|two| u8::from_str_radix(two, 16).ok()).unwrap_or(0))
        })
        .collect();
    let mut file = vec![0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];
    for (name, content) in [(b"IHDR", header), (b"PLTE", palette), (b"IDAT", data), (b"IEND", Vec::new())] {
        file.extend((content.len() as u32).to_be_bytes());
        let begin = file.len();
        file.extend(name);
        file.extend(content);
        let check = crc(&file[begin..]);
        file.extend(check.to_be_bytes());
    }
    file
}

fn adler(bytes: &[u8]) -> u32 {
    let (a, b) = bytes.iter().fold((1u32, 0u32), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % 65521;
        (a, (a + b) % 65521)
    });
    (b << 16) | a
}

fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    };
    !bytes.iter().fold(!0, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_the_standards() {
        assert_eq!(crc(b"123456789"), 0xcbf4_3926);
        assert_eq!(adler(b"Wikipedia"), 0x11e6_0398);
    }

    #[test]
    fn a_picture_has_its_rows_and_colours() {
        let file =
            png(300, &vec![1.0; 300 * 250], |v| if v == 1.0 { "#010203".into() } else { "#ffffff".into() });
        assert_eq!(&file[16..24], [0, 0, 1, 44, 0, 0, 0, 250]);
        let palette = file.windows(4).position(|w| w == b"PLTE").unwrap() + 4;
        assert_eq!(&file[palette + 3 * (SHADES - 1)..palette + 3 * SHADES], [1, 2, 3]);
        // Two blocks of 65,535 and 9,715 bytes, and the first row has no filter.
        let data = file.windows(4).position(|w| w == b"IDAT").unwrap() + 4;
        assert_eq!(&file[data..data + 9], [0x78, 1, 0, 0xff, 0xff, 0, 0, 0, 127]);
        assert_eq!(&file[data + 7 + 65535..data + 10 + 65535], [1, 0xf3, 0x25]);
    }
}
