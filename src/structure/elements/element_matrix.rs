//! A small square matrix of any size.

use nalgebra::SMatrix;

/// A square matrix of any size, column by column, whose memory serves one element after the other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ElementMatrix {
    size: usize,
    values: Vec<f64>,
}

impl ElementMatrix {
    /// Makes it the zero matrix of `size` rows.
    pub fn reset(&mut self, size: usize) {
        self.size = size;
        self.values.clear();
        self.values.resize(size * size, 0.0);
    }

    /// The number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Column `j`.
    pub fn column(&self, j: usize) -> &[f64] {
        &self.values[j * self.size..(j + 1) * self.size]
    }

    /// The entry in row `i` of column `j`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.values[j * self.size + i]
    }

    /// Sets the entry in row `i` of column `j`.
    pub fn set(&mut self, i: usize, j: usize, value: f64) {
        self.values[j * self.size + i] = value;
    }

    /// Takes the entries of a matrix of as many rows.
    ///
    /// # Panics
    /// When it has another number of rows.
    pub fn copy<const N: usize>(&mut self, from: &SMatrix<f64, N, N>) {
        self.values.copy_from_slice(from.as_slice());
    }

    /// Adds `factor` · `block`, whose row k is row `rows[k]` here.
    pub fn add<const N: usize>(&mut self, block: &SMatrix<f64, N, N>, rows: &[usize; N], factor: f64) {
        for (j, column) in rows.iter().enumerate() {
            for (i, row) in rows.iter().enumerate() {
                self.values[column * self.size + row] += factor * block[(i, j)];
            }
        }
    }

    /// Adds a block to the rows 3i, 3i + 1, 3i + 2 of the columns 3j, 3j + 1, 3j + 2.
    pub fn add_block(&mut self, i: usize, j: usize, block: &SMatrix<f64, 3, 3>) {
        for c in 0..3 {
            let start = (3 * j + c) * self.size + 3 * i;
            for (value, add) in self.values[start..start + 3].iter_mut().zip(block.column(c).iter()) {
                *value += add;
            }
        }
    }

    /// Becomes `factor` (A − Aᵀ).
    pub fn become_skew(&mut self, factor: f64) {
        for j in 0..self.size {
            for i in 0..=j {
                let value = factor * (self.get(i, j) - self.get(j, i));
                self.set(i, j, value);
                self.set(j, i, -value);
            }
        }
    }

    /// Becomes `factor` A.
    pub fn scale(&mut self, factor: f64) {
        self.values.iter_mut().for_each(|value| *value *= factor);
    }

    /// Copies what is above the diagonal to below it.
    pub fn mirror(&mut self) {
        for j in 0..self.size {
            for i in 0..j {
                self.values[i * self.size + j] = self.values[j * self.size + i];
            }
        }
    }

    /// Sets it to α A + β B, of two matrices of one size.
    pub fn set_sum(&mut self, [alpha, beta]: [f64; 2], [a, b]: [&ElementMatrix; 2]) {
        self.size = a.size;
        self.values.clear();
        self.values.extend(a.values.iter().zip(&b.values).map(|(a, b)| a * alpha + b * beta));
    }
}
