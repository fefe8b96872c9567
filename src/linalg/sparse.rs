//! The sparse matrix of the whole program, and sparse vectors for contact directions.

/// A sparse matrix in compressed columns. Symmetric matrices are stored whole (both triangles), so that a
/// column is also a row and products run over rows in parallel.
pub type SparseMatrix = faer::sparse::SparseColMat<usize, f64>;

/// A sparse vector: `values[k]` stands at `indices[k]`; indices ascend and do not repeat.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SparseVector {
    indices: Vec<usize>,
    values: Vec<f64>,
}

impl SparseVector {
    /// Sorts `entries`, adds up those with the same index, and drops exact zeros.
    ///
    /// ```
    /// let v = stridor::linalg::SparseVector::from_entries([(4, 1.0), (2, 3.0), (4, 0.5)]);
    /// assert_eq!(v.indices(), [2, 4]);
    /// assert_eq!(v.dot(&[0.0, 0.0, 1.0, 0.0, 2.0]), 6.0);
    /// ```
    pub fn from_entries(entries: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let mut entries: Vec<(usize, f64)> = entries.into_iter().collect();
        entries.sort_by_key(|(index, _)| *index);
        let mut vector = SparseVector::default();
        for (index, value) in entries {
            if vector.indices.last() == Some(&index) {
                *vector.values.last_mut().expect("as long as indices") += value;
            } else {
                vector.indices.push(index);
                vector.values.push(value);
            }
        }
        let keep: Vec<bool> = vector.values.iter().map(|v| *v != 0.0).collect();
        let mut k = keep.iter();
        vector.indices.retain(|_| *k.next().expect("same length"));
        vector.values.retain(|v| *v != 0.0);
        vector
    }

    /// The places of the entries, ascending.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    /// The entries, in the order of [`SparseVector::indices`].
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Index and value of every entry.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.indices.iter().copied().zip(self.values.iter().copied())
    }

    /// The scalar product with a dense vector.
    pub fn dot(&self, dense: &[f64]) -> f64 {
        self.iter().map(|(i, v)| v * dense[i]).sum()
    }

    /// `dense += factor · self`.
    pub fn add_to(&self, factor: f64, dense: &mut [f64]) {
        for (i, v) in self.iter() {
            dense[i] += factor * v;
        }
    }
}
