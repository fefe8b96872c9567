//! Elements of a chart that plotters does not write, in place of the texts that stand for them: see [`super::readout`] and
//! [`super::curve`].

/// Begins such a text; the next character says which element it is.
pub(super) const ELEMENT: char = '\u{e000}';
/// Between its fields.
pub(super) const FIELD: char = '\u{e001}';
/// Radius within which a point shows its title \[px\].
const REACH: u32 = 9;

/// The picture with its elements in place of those texts.
pub(super) fn elements(svg: &str) -> String {
    let mut done = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some(at) = rest.find(ELEMENT) {
        let begin = rest[..at].rfind("<text").unwrap_or(at);
        let words = &rest[at + ELEMENT.len_utf8()..];
        let end = words.find("</text>").unwrap_or(words.len());
        done += &rest[..begin];
        done += &element(words[..end].trim_end());
        rest = words[end..].strip_prefix("</text>").unwrap_or_default();
    }
    done + rest
}

/// One element; plotters has escaped the words already. Nothing where they are not of the form above.
fn element(words: &str) -> String {
    let fields: Vec<&str> = words.get(1..).unwrap_or_default().split(FIELD).collect();
    match (words.chars().next(), &fields[..]) {
        (Some('a'), [x, y, w, h, x0, x1, y0, y1, dx, dy, name_x, name_y]) => format!(
            "<rect class=\"axes\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"none\" data-x=\"{x0} {x1} {dx}\" \
             data-y=\"{y0} {y1} {dy}\" data-names=\"{name_x}|{name_y}\"/>"
        ),
        (Some('t'), [x, y, title]) => {
            format!(
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{REACH}\" fill-opacity=\"0\"><title>{title}</title></circle>"
            )
        }
        (Some('l'), [hex, width, opacity, dash, points]) => format!(
            "<path d=\"M{points}\" fill=\"none\" stroke=\"{hex}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\" \
             stroke-dasharray=\"{dash}\" stroke-linejoin=\"round\"/>"
        ),
        (Some('c'), [x, y, radius, fill, stroke, width]) => format!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"{width}\"/>"
        ),
        _ => String::new(),
    }
}
