//! Products of reference coordinates, of which shape functions are combinations.

/// Exponents of x, y, z and r.
pub(crate) type Product = [u8; 4];

/// The products of a kind.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Products {
    /// All of this degree at most.
    Complete(u8),
    /// Those with this exponent at most of each coordinate.
    Tensor(u8),
    /// Those with exponents of two at most, and of two once at most.
    Serendipity,
    /// Those of this degree at most in x and y, with this exponent at most of z.
    Prism(u8),
    /// These.
    Listed(&'static [Product]),
}

impl Products {
    pub(crate) fn list(self, dimension: usize) -> Vec<Product> {
        let all = |most: u8| {
            let [a, b, c] = [0, 1, 2].map(|k| if k < dimension { most } else { 0 });
            (0..=a).flat_map(move |x| (0..=b).flat_map(move |y| (0..=c).map(move |z| [x, y, z, 0])))
        };
        let twos = |p: &Product| p[..3].iter().filter(|e| **e == 2).count();
        match self {
            Products::Complete(degree) => all(degree).filter(|p| p[0] + p[1] + p[2] <= degree).collect(),
            Products::Tensor(most) => all(most).collect(),
            Products::Serendipity => all(2).filter(|p| twos(p) <= 1).collect(),
            Products::Prism(degree) => all(degree).filter(|p| p[0] + p[1] <= degree).collect(),
            Products::Listed(products) => products.to_vec(),
        }
    }
}
