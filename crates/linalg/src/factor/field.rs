//! The numbers that are factorised, real and complex, and bundles of them that a solve carries side by side.

use super::super::lanes::Aligned;
use super::super::{c64, sparse};
use faer::traits::ComplexField;
use std::ops::{Add, Div, Neg, Sub};

/// A number of a factorised matrix: `f64` or `c64`.
pub trait Field:
    'static
    + sparse::Scalar
    + ComplexField<Real = f64>
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + std::ops::Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// One row of K right-hand sides.
    type Lanes<const K: usize>: Lanes<Self>;
    /// One row of many, which begins with a line of the cache: a register that is filled from two lines takes twice the time.
    type Wide<const K: usize>: Lanes<Self>;

    /// |x|, or |Re x| + |Im x|, which is within √2 of it and cheaper.
    fn size(self) -> f64;

    /// |x|.
    fn modulus(self) -> f64;

    /// The conjugate of x.
    fn conjugate(self) -> Self;

    /// Re x.
    fn real_part(self) -> f64;

    /// self − a b, rounded once for each real product where the processor can.
    fn minus(self, a: Self, b: Self) -> Self;
}

/// One row of a block of right-hand sides, its columns side by side in memory.
pub trait Lanes<T>: Copy + Send + Sync + 'static {
    /// How many columns.
    const COLUMNS: usize;
    /// A row of zeros.
    const ZERO: Self;
    /// The value in column k.
    fn get(&self, k: usize) -> T;
    /// Sets the value in column k.
    fn set(&mut self, k: usize, value: T);
    /// Whether all columns are zero.
    fn is_zero(&self) -> bool;
    /// self += other.
    fn add(&mut self, other: &Self);
    /// self −= l · y.
    fn subtract(&mut self, l: T, y: &Self);
}

impl Field for f64 {
    type Lanes<const K: usize> = [f64; K];
    type Wide<const K: usize> = Aligned<[f64; K]>;

    #[inline(always)]
    fn size(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn modulus(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn conjugate(self) -> f64 {
        self
    }

    #[inline(always)]
    fn real_part(self) -> f64 {
        self
    }

    #[inline(always)]
    fn minus(self, a: f64, b: f64) -> f64 {
        (-a).mul_add(b, self)
    }
}

impl Field for c64 {
    type Lanes<const K: usize> = Split<K>;
    type Wide<const K: usize> = Aligned<Split<K>>;

    #[inline(always)]
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }

    #[inline(always)]
    fn modulus(self) -> f64 {
        self.norm()
    }

    #[inline(always)]
    fn conjugate(self) -> c64 {
        self.conj()
    }

    #[inline(always)]
    fn real_part(self) -> f64 {
        self.re
    }

    #[inline(always)]
    fn minus(self, a: c64, b: c64) -> c64 {
        c64::new(
            a.im.mul_add(b.im, (-a.re).mul_add(b.re, self.re)),
            (-a.im).mul_add(b.re, (-a.re).mul_add(b.im, self.im)),
        )
    }
}

/// A row of one.
impl<T: Field> Lanes<T> for T {
    const COLUMNS: usize = 1;
    const ZERO: Self = <T as sparse::Scalar>::ZERO;

    #[inline(always)]
    fn get(&self, _: usize) -> T {
        *self
    }

    #[inline(always)]
    fn set(&mut self, _: usize, value: T) {
        *self = value;
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        *self == <T as sparse::Scalar>::ZERO
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        *self += *other;
    }

    #[inline(always)]
    fn subtract(&mut self, l: T, y: &Self) {
        *self = self.minus(l, *y);
    }
}

impl<const K: usize> Lanes<f64> for [f64; K] {
    const COLUMNS: usize = K;
    const ZERO: Self = [0.0; K];

    #[inline(always)]
    fn get(&self, k: usize) -> f64 {
        self[k]
    }

    #[inline(always)]
    fn set(&mut self, k: usize, value: f64) {
        self[k] = value;
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        *self == Self::ZERO
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        for k in 0..K {
            self[k] += other[k];
        }
    }

    #[inline(always)]
    fn subtract(&mut self, l: f64, y: &Self) {
        for k in 0..K {
            self[k] = (-l).mul_add(y[k], self[k]);
        }
    }
}

/// K complex numbers, the real parts apart from the imaginary ones, as the vector unit likes them.
#[derive(Debug, Clone, Copy)]
pub struct Split<const K: usize> {
    re: [f64; K],
    im: [f64; K],
}

impl<const K: usize> Lanes<c64> for Split<K> {
    const COLUMNS: usize = K;
    const ZERO: Self = Split { re: [0.0; K], im: [0.0; K] };

    #[inline(always)]
    fn get(&self, k: usize) -> c64 {
        c64::new(self.re[k], self.im[k])
    }

    #[inline(always)]
    fn set(&mut self, k: usize, value: c64) {
        (self.re[k], self.im[k]) = (value.re, value.im);
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.re == [0.0; K] && self.im == [0.0; K]
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        for k in 0..K {
            self.re[k] += other.re[k];
            self.im[k] += other.im[k];
        }
    }

    #[inline(always)]
    fn subtract(&mut self, l: c64, y: &Self) {
        for k in 0..K {
            self.re[k] = l.im.mul_add(y.im[k], (-l.re).mul_add(y.re[k], self.re[k]));
            self.im[k] = (-l.im).mul_add(y.re[k], (-l.re).mul_add(y.im[k], self.im[k]));
        }
    }
}

impl<T, L: Lanes<T>> Lanes<T> for Aligned<L> {
    const COLUMNS: usize = L::COLUMNS;
    const ZERO: Self = Aligned(L::ZERO);

    #[inline(always)]
    fn get(&self, k: usize) -> T {
        self.0.get(k)
    }

    #[inline(always)]
    fn set(&mut self, k: usize, value: T) {
        self.0.set(k, value);
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    #[inline(always)]
    fn add(&mut self, other: &Self) {
        self.0.add(&other.0);
    }

    #[inline(always)]
    fn subtract(&mut self, l: T, y: &Self) {
        self.0.subtract(l, &y.0);
    }
}
