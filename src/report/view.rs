//! Small vectors, and the directions from which pictures show a model.

/// A vector or a place in space.
pub(super) type ViewVector = [f64; 3];

pub(super) fn dot(a: ViewVector, b: ViewVector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: ViewVector, b: ViewVector) -> ViewVector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a + s b`.
pub(super) fn along(a: ViewVector, s: f64, b: ViewVector) -> ViewVector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// `a` at length one; `None` where it has no direction.
pub(super) fn unit(a: ViewVector) -> Option<ViewVector> {
    let length = dot(a, a).sqrt();
    (length > 0.0 && length.is_finite()).then(|| a.map(|c| c / length))
}

/// A parallel projection: what is to the right, what is up, and towards the viewer.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    pub right: ViewVector,
    pub up: ViewVector,
    pub towards: ViewVector,
}

impl View {
    /// Looks against `towards` with z up (y where one looks along z); `None` where `towards` has no direction.
    pub(super) fn facing(towards: ViewVector) -> Option<Self> {
        let towards = unit(towards)?;
        let upright = if towards[2].abs() < 0.999 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
        let right = unit(cross(upright, towards))?;
        Some(View { right, up: cross(towards, right), towards })
    }

    /// Coordinates on the picture, y upwards, in metres.
    pub(super) fn project(&self, place: ViewVector) -> [f64; 2] {
        [dot(self.right, place), dot(self.up, place)]
    }

    /// Larger is nearer to the viewer.
    pub(super) fn nearness(&self, place: ViewVector) -> f64 {
        dot(self.towards, place)
    }
}

/// Metres on the picture to pixels on the sheet: a box of the sheet is filled as far as equal scales allow.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlacedView {
    scale: f64,
    centre: [f64; 2],
    middle: [f64; 2],
}

impl PlacedView {
    /// Fits `places` into the box with the upper left corner `corner` and the size `size`.
    pub(super) fn new(places: impl IntoIterator<Item = [f64; 2]>, corner: [f64; 2], size: [f64; 2]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for place in places {
            for c in 0..2 {
                low[c] = low[c].min(place[c]);
                high[c] = high[c].max(place[c]);
            }
        }
        let extent = [high[0] - low[0], high[1] - low[1]];
        let scale = (size[0] / extent[0]).min(size[1] / extent[1]);
        PlacedView {
            scale: if scale.is_finite() && scale > 0.0 { scale } else { 1.0 },
            centre: [0, 1].map(|c| if extent[c].is_finite() { 0.5 * (low[c] + high[c]) } else { 0.0 }),
            middle: [corner[0] + 0.5 * size[0], corner[1] + 0.5 * size[1]],
        }
    }

    /// The pixel of a place.
    pub(super) fn pixel(&self, place: [f64; 2]) -> [f64; 2] {
        [
            self.middle[0] + self.scale * (place[0] - self.centre[0]),
            self.middle[1] - self.scale * (place[1] - self.centre[1]),
        ]
    }

    /// Pixels a metre.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_is_right_handed_and_upright() {
        let view = View::facing([1.0, 0.0, 0.0]).unwrap();
        assert_eq!((view.right, view.up), ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
        let tilted = View::facing([1.0, -2.0, 0.7]).unwrap();
        assert!(dot(cross(tilted.right, tilted.up), tilted.towards) > 1.0 - 1e-14 && tilted.up[2] > 0.0);
        assert!(View::facing([0.0; 3]).is_none());
    }
}
