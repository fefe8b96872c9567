//! Blocks on springs that a belt slides under, against closed forms: equal ones, and ones that nothing presses.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fmt::Write as _;
use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::job::{Prepared, Selection, analyse};
use stridor::results::{RunResults, SweepResult, TransientResult};
use stridor::sweep::CriticalKind;

/// A block of 1 kg: k₁ and k_t along x, k₂ along (1, −1)/√2, k_n of the contact along y, which also pulls.
#[derive(Clone, Copy)]
struct Block {
    along: f64,
    oblique: f64,
    normal: f64,
    cubic: f64,
    friction: f64,
}

impl Block {
    fn random(random: &mut ChaCha8Rng) -> Block {
        let [along, oblique, normal] = [0.5, 0.6, 0.8].map(|low: f64| random.gen_range(low..2.0 * low));
        Block { along, oblique, normal, cubic: 0.0, friction: 0.4 }
    }

    /// μ at which the two frequencies merge: K = [k₁ + k₂/2, −k₂/2 + μ k_n; −k₂/2, k₂/2 + k_n] has a double eigenvalue.
    fn merging(self) -> f64 {
        let half = 0.5 * (self.along - self.normal);
        (half * half + 0.25 * self.oblique * self.oblique) / (0.5 * self.oblique * self.normal)
    }

    /// Of `count` such blocks, each pressed by `press` \[N\].
    fn case(self, count: usize, press: f64) -> String {
        let Block { along, oblique, normal, cubic, friction } = self;
        let mut text = "[point]\n".to_string();
        for k in 0..count {
            let _ = writeln!(text, "block{k} = [{k}, 0, 0]");
        }
        for k in 0..count {
            let _ = writeln!(
                text,
                "[mass.block{k}]\non = \"block{k}\"\nmass = 1\n\
                 [support.block{k}]\non = \"block{k}\"\nheld = [\"uz\", \"rx\", \"ry\", \"rz\"]\n\
                 [spring.along{k}]\non = \"block{k}\"\ndirection = [1, 0, 0]\nstiffness = {along}\n\
                 [spring.oblique{k}]\non = \"block{k}\"\ndirection = [1, -1, 0]\nstiffness = {oblique}\n\
                 [contact.belt{k}]\nbody = \"block{k}\"\ncounter = \"ground\"\ninto = [0, 1, 0]\napproach = 0\n\
                 sliding_velocity = 1\nsliding_direction = [-1, 0, 0]\n\
                 normal = {{ per = \"point\", stiffness = {normal}, cubic = {cubic}, unilateral = false }}\n\
                 friction = {{ law = \"coulomb\", mu0 = {friction} }}"
            );
            if press != 0.0 {
                let _ = writeln!(text, "[force.press{k}]\non = \"block{k}\"\nforce = [0, {press}, 0]");
            }
        }
        text + "[cea]\nband = [0, 1]\n"
    }
}

fn run(text: &str) -> RunResults {
    let case = Case::parse("case.toml", text, ".".into()).unwrap_or_else(|error| panic!("{error}"));
    let prepared = Prepared::new(&case).unwrap();
    analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).unwrap_or_else(|error| panic!("{error}"))
}

/// The eigenvalues of equal blocks are double, triple, … along all of the sweep of one of them. Some sweeps have the critical value, at
/// which two eigenvalues share one vector, among their points.
#[test]
fn critical_values_of_equal_parts_are_those_of_one() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for trial in 0..6 {
        let (mut block, count) = (Block::random(&mut random), 1 + trial % 3);
        let exact = block.merging();
        block.friction = 0.4 * exact;
        let (to, points) = [(2.0 * exact, 5), (1.9 * exact, 2), (1.6 * exact, 8)][trial % 3];
        let sweep = format!(
            "[sweep.belt]\nparameter = \"contact.belt0.friction.mu0\"\nfrom = 0\nto = {to}\npoints = {points}\n"
        );
        let results = run(&(block.case(count, 1.0) + &sweep));
        let result = results.get::<SweepResult>().unwrap();
        let found: Vec<_> =
            result.sweep.critical.iter().filter(|c| c.kind == CriticalKind::Merging).collect();
        let [critical] = found[..] else {
            panic!("{trial}: {} critical values", result.sweep.critical.len())
        };
        // λ splits by the root of the distance: rounding of 1e-16 moves the value by as much, the bracket is of 1e-10.
        let error = (critical.value - exact).abs();
        assert!(within(error, 1e-8 * exact, RoundOff), "{trial}: {} {exact}", critical.value);
        let stated = result.value_error(0);
        assert!(stated.is_finite() && stated >= 0.01 * error / exact, "{trial}: {stated:e}");
    }
}

/// A contact that cannot open keeps its stiffness without a preload: a linear one at any amplitude, a cubic one while 3 k₃δ² is small
/// beside k.
#[test]
fn growth_of_a_contact_that_pulls_needs_no_preload() {
    let mut random = ChaCha8Rng::seed_from_u64(12);
    for trial in 0..8 {
        let mut block = Block::random(&mut random);
        block.friction = random.gen_range(1.2..2.0) * block.merging();
        block.cubic = if trial % 2 == 0 { 0.0 } else { 1.0 };
        let amplitude = 10f64.powi([-14, -6, -3, -9][trial % 4]);
        let transient = format!(
            "[transient]\nduration = 40\ntime_step = 0.02\ndisturbance = {{ amplitude = {amplitude:e} }}\n"
        );
        let results = run(&(block.case(1, 0.0) + &transient));
        let growth = results.get::<TransientResult>().unwrap().growth.as_ref().expect("a disturbance");
        let found = growth.found.unwrap_or_else(|| panic!("{trial}: {:?}", growth.refused));
        // (ωΔt)²/12 of Newmark's method is 1e-4 of |λ|; the stiffness of the cubic spring changes by 1 % at most while it is small.
        let aim = growth.eigenvalue.re;
        assert!(
            within((found.rate - aim).abs(), 1e-3 * growth.eigenvalue.norm(), Discretisation),
            "{trial}: {} {aim}",
            found.rate
        );
    }
}
