//! Labels of a chart that do not cover each other.

use super::chart::{Area, above, bold, colour};
use super::colours::{ALARM, ALARM_TEXT};
use plotters::prelude::*;
use std::error::Error;

/// Height of a label \[px\].
pub(super) const LABEL_HEIGHT: i32 = 17;

/// Places of the labels: left, top, right, lower edge \[px\].
#[derive(Debug, Default)]
pub(super) struct Labels(Vec<[i32; 4]>);

impl Labels {
    /// The lower edge of a label of `width` × [`LABEL_HEIGHT`] about `x`, at `y` or the next place in steps of `step` that is free.
    pub(super) fn place(&mut self, x: i32, mut y: i32, width: i32, step: i32) -> i32 {
        let (left, right) = (x - width / 2, x + width / 2);
        let covers =
            |y: i32, [l, t, r, b]: &[i32; 4]| left < *r && right > *l && y - LABEL_HEIGHT < *b && y > *t;
        while self.0.iter().any(|other| covers(y, other)) {
            y += step;
        }
        self.0.push([left, y - LABEL_HEIGHT, right, y]);
        y
    }

    /// Whether no label covers another.
    #[cfg(test)]
    pub(super) fn apart(&self) -> bool {
        self.0.iter().enumerate().all(|(k, [left, top, right, low])| {
            let free = |[l, t, r, b]: &[i32; 4]| right <= l || left >= r || low <= t || top >= b;
            self.0[k + 1..].iter().all(free)
        })
    }
}

/// Words above the mark of an unstable mode at a pixel of the whole sheet, where they cover no other label; a line joins them to a mark that
/// they are moved away from.
pub(super) fn label_unstable(
    area: &Area,
    labels: &mut Labels,
    (x, mark): (i32, i32),
    words: &str,
) -> Result<(), Box<dyn Error>> {
    let y = labels.place(x, mark - 9, 64, -4);
    if y < mark - 9 {
        let line = [local(area, x, y), local(area, x, mark - 7)];
        area.draw(&PathElement::new(line, colour(ALARM).mix(0.5).stroke_width(1)))?;
    }
    area.draw_text(words, &above(bold(13.5, ALARM_TEXT)), local(area, x, y))?;
    Ok(())
}

/// A pixel of the whole sheet as a pixel of `area`.
pub(super) fn local(area: &Area, x: i32, y: i32) -> (i32, i32) {
    let (left, top) = area.get_base_pixel();
    (x - left, y - top)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_do_not_cover_each_other() {
        let mut labels = Labels::default();
        let places: Vec<i32> = [100, 130, 160, 100, 400].map(|x| labels.place(x, 200, 64, -4)).to_vec();
        assert_eq!((places[0], places[4]), (200, 200));
        assert!(labels.apart(), "{labels:?}");
    }
}
