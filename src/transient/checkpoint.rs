//! State needed to resume a run in time, as named arrays that any file can hold.

use super::energy_balance::Work;
use super::march::{Control, Marched};
use super::model::TransientModel;
use super::reaction::Bristles;
use super::slopes::PointSlopes;
use super::state::State;
use crate::error::{Error, Fault, Result};
use faer::Mat;
use std::collections::BTreeMap;

/// Named arrays of numbers. Counts are among them: a double holds every whole number below 2⁵³.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checkpoint {
    /// Each array by its name.
    pub arrays: BTreeMap<String, Vec<f64>>,
}

impl Checkpoint {
    /// Adds an array.
    pub fn put(&mut self, name: impl Into<String>, values: &[f64]) {
        self.arrays.insert(name.into(), values.to_vec());
    }

    /// Copies the array of this name to `values`.
    ///
    /// # Errors
    /// Input: there is none, or it has another length. It is of another model then.
    pub fn get(&self, name: &str, values: &mut [f64]) -> Result<()> {
        match self.arrays.get(name) {
            Some(array) if array.len() == values.len() => values.copy_from_slice(array),
            array => {
                let found = format!("{} numbers", array.map_or(0, Vec::len));
                let fault =
                    Fault::new(format!("checkpoint `{name}`"), found, format!("{} numbers", values.len()));
                let help = "It is of another model: run without --resume";
                return Err(Error::input(fault.with_help(help)));
            }
        }
        Ok(())
    }

    /// Copies a single array to many numbers.
    ///
    /// # Errors
    /// As [`Checkpoint::get`].
    pub fn numbers<const N: usize>(&self, name: &str) -> Result<[f64; N]> {
        let mut values = [0.0; N];
        self.get(name, &mut values)?;
        Ok(values)
    }

    /// Adds all that a run needs to resume.
    pub fn put_march(&mut self, marched: &Marched) {
        let Marched { begin, step, state, work, worst_residual, split, control } = marched;
        let counts = [*step, split.0, split.1, control.level, control.parts].map(|count| count as f64);
        self.put("march", &[*begin, state.time, *worst_residual, control.fastest]);
        self.put("march_counts", &counts);
        self.put("work", &work.terms());
        // What a state does not follow from otherwise. What a law remembers belongs here too.
        self.put_columns("free_motion", &state.motion);
        state.modal.iter().for_each(|modal| self.put_columns("modal", modal));
        self.put("reaction", &state.reaction);
        self.put("approaches", &state.interface.approaches);
        state.slopes.iter().for_each(|slopes| self.put("slopes", &slopes.numbers));
        let bristles = state.bristles.iter();
        let kept = bristles.flat_map(|b| [b.bent[0], b.bent[1], f64::from(u8::from(b.stick))]);
        self.put("bristles", &kept.collect::<Vec<f64>>());
    }

    /// The march that was put here.
    ///
    /// # Errors
    /// Input: it is of another model.
    pub fn march(&self, model: &TransientModel<'_>) -> Result<Marched> {
        let [begin, time, worst_residual, fastest] = self.numbers("march")?;
        let [step, split, most, level, parts] =
            self.numbers("march_counts")?.map(|count: f64| count as usize);
        let terms: [f64; 9] = self.numbers("work")?;
        let mut work = Work::default();
        work.terms_mut().into_iter().zip(terms).for_each(|(term, value)| *term = value);
        let mut state = State::empty(model);
        self.get_columns("free_motion", &mut state.motion)?;
        state.modal.iter_mut().try_for_each(|modal| self.get_columns("modal", modal))?;
        self.get("reaction", &mut state.reaction)?;
        let mut kept = vec![0.0; 3 * state.bristles.len()];
        self.get("bristles", &mut kept)?;
        for (bristles, kept) in state.bristles.iter_mut().zip(kept.chunks(3)) {
            *bristles = Bristles { bent: [kept[0], kept[1]], stick: kept[2] != 0.0 };
        }
        self.get("approaches", &mut state.interface.approaches)?;
        if self.arrays.contains_key("slopes") {
            let mut numbers = vec![0.0; PointSlopes::count(model)];
            self.get("slopes", &mut numbers)?;
            state.slopes = Some(PointSlopes { numbers }.into());
        }
        state.act(model, time);
        state.derive(model);
        let control = Control { level, fastest, parts };
        Ok(Marched { begin, step, state, work, worst_residual, split: (split, most), control })
    }

    /// Adds a matrix, column after column.
    fn put_columns(&mut self, name: &str, matrix: &Mat<f64>) {
        let values = (0..matrix.ncols()).flat_map(|k| matrix.col_as_slice(k)).copied().collect();
        self.arrays.insert(name.into(), values);
    }

    fn get_columns(&self, name: &str, matrix: &mut Mat<f64>) -> Result<()> {
        let rows = matrix.nrows();
        let mut values = vec![0.0; rows * matrix.ncols()];
        self.get(name, &mut values)?;
        for k in 0..matrix.ncols() {
            matrix.col_as_slice_mut(k).copy_from_slice(&values[k * rows..(k + 1) * rows]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Plan, Scheme, StepMethod, TimeProfile, march, resume};
    use super::*;
    use crate::equilibrium::samples::{random_system, skew_parts};
    use crate::equilibrium::{SteadyOptions, solve_steady};
    use crate::linalg::c64;
    use crate::system::ModalDamping;

    #[test]
    fn a_march_that_was_put_away_goes_on_bit_for_bit() {
        for method in [StepMethod::Condensed, StepMethod::FullNewton] {
            let mut system = random_system(12, 3, 2.0, 4);
            system.coupling = Some(skew_parts(12, 5, 3.0, 0.0));
            let basis = Mat::from_fn(12, 2, |i, j| ((1 + i) as f64 * (0.3 + j as f64)).sin());
            system.structure.damping.modal = Some(ModalDamping { basis, coefficients: vec![0.1, 0.2] });
            let steady = solve_steady(&system, &SteadyOptions::default(), &()).unwrap();
            let profile = TimeProfile::Reciprocating { frequency_hz: 0.7, phase: 0.1 };
            let model = TransientModel::new(&system, &steady).unwrap().driven(vec![profile], vec![]);
            let shape: Vec<c64> = (0..12).map(|k| c64::new(0.02 * k as f64, 0.1)).collect();
            let start = State::steady(&model, &steady).disturbed(&model, c64::new(0.0, 3.0), &shape, 1.0);
            let scheme = Scheme::hht(-0.05);
            let plan = Plan { scheme, step: 1e-2, steps: 200, method, tolerance: None };
            let mut middle = Checkpoint::default();
            let whole = march(&model, start, &plan, &(), &mut |marched| {
                if marched.step == 77 {
                    middle.put_march(marched);
                }
                Ok(())
            });
            let mut again = middle.march(&model).unwrap();
            let mut seen = 0;
            resume(&model, &mut again, &plan, &(), &mut |_| {
                seen += 1;
                Ok(())
            })
            .unwrap();
            let packed = |marched: &Marched| {
                let mut end = Checkpoint::default();
                end.put_march(marched);
                end
            };
            assert_eq!(seen, 123);
            assert!(packed(&again) == packed(&whole.unwrap()), "{method:?}");
        }
    }

    #[test]
    fn a_checkpoint_of_another_model_is_refused() {
        let small = random_system(12, 3, 2.0, 4);
        let large = random_system(14, 3, 2.0, 4);
        let [small, large] =
            [&small, &large].map(|s| (s, solve_steady(s, &SteadyOptions::default(), &()).unwrap()));
        let model = TransientModel::new(small.0, &small.1).unwrap();
        let mut checkpoint = Checkpoint::default();
        checkpoint.put_march(&State::steady(&model, &small.1).into());
        let other = TransientModel::new(large.0, &large.1).unwrap();
        let error = checkpoint.march(&other).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("36 numbers"), "{error}");
    }
}
