//! Determines the gains of the gauges relative to each other, the friction of the joints and the friction of the
//! pulleys, from the tensions of a free finger whose joints move back and forth at two levels of common tension and at
//! two speeds.
//!
//! Let t be the tensions at the gauges. Because of the friction mu_i of the pulleys, tension i at the joint is f_i t_i
//! with f_i = (1 + mu_i)^-d_i; d_i is +1 while the tendon moves toward its motor and -1 otherwise. With the moment arms
//! R, the joint rates v and their signs s,
//!
//! R f t = g + s (C + b |v|)
//!
//! with the joint torques g of gravity, and the Coulomb friction C and the viscous friction b of the joints. Half
//! of the difference between the two directions of a motion eliminates g. C is the same at both levels of tension and
//! both speeds, so that C, b and the four mu can be separated. The mean of both directions eliminates the friction, and
//! g is the same at both levels. So the rise of the mean of f t between the levels is along the null vector of R. This
//! gives the gains of the gauges up to a common factor. The tensions of a free finger do not show this factor.

use super::least_squares::LeastSquares;
use crate::calibration::average::Average;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::model::Part;
use nalgebra::{SVector, Vector3, Vector4};

/// Number of motions back and forth.
pub(super) const STROKES: usize = 5;
/// Number of oblique directions: directions in joint space along which all joints move at the same time.
const DIRECTIONS: usize = 2;
/// Number of Gauss-Newton steps. The equations are nearly linear.
const ROUNDS: usize = 5;
/// Weight of the assumption that all pulleys have the same friction, N cm. The assumption matters only if the motions
/// do not distinguish the friction of the four tendons.
const LIKENESS: f64 = 0.3;
/// Weight of the configured viscous friction, rad/s. The motions determine C more accurately than b.
const KNOWN: f64 = 0.2;
/// If the speed of a tendon is below this part of the speed of the fastest tendon, its direction is uncertain.
const DIRECTED: f64 = 0.05;
/// Largest plausible friction of the pulleys.
const LARGEST: f64 = 0.6;
/// Smallest and largest plausible factor of a gauge, relative to the mean factor.
const GAINS: std::ops::Range<f64> = 0.5..2.0;

/// A motion back and forth along one direction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stroke {
    /// Whether the common tension is at its higher level.
    pub high: bool,
    /// Joint rates, rad/s.
    pub rates: Vector3<f64>,
    /// Number of the oblique direction.
    pub direction: usize,
}

/// The mean tensions of every motion, separately for the way back and the way forth.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointFriction {
    strokes: [(Stroke, [Average; 2]); STROKES],
}

/// What the tensions of a free finger show.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeFinger {
    /// Factors for the tensions of the gauges. They do not change the mean of the configured gains (N per count).
    pub gains: Vector4<f64>,
    /// Relative uncertainty of the gains: the largest difference between the gains from one direction of motion and the
    /// gains from all directions.
    pub gain_uncertainty: f64,
    /// C, N cm.
    pub coulomb: Vector3<f64>,
    /// b, N cm s/rad.
    pub viscous: Vector3<f64>,
    /// mu of the pulleys.
    pub pulley: Vector4<f64>,
}

impl JointFriction {
    pub fn new() -> Self {
        Self { strokes: [(Stroke::default(), [Average::default(); 2]); STROKES] }
    }

    /// Adds tensions, N, of a motion. `way` is 0 on the way back and 1 on the way forth.
    pub fn add(&mut self, motion: usize, way: usize, stroke: Stroke, tensions: Vector4<f64>) {
        let (known, averages) = &mut self.strokes[motion];
        *known = Stroke { rates: stroke.rates * if way == 0 { -1.0 } else { 1.0 }, ..stroke };
        averages[way].add(tensions);
    }

    pub fn solve(&self, instruments: &Instruments) -> Result<FreeFinger, Obstacle> {
        let mut found = FreeFinger {
            gains: Vector4::repeat(1.0),
            gain_uncertainty: 0.0,
            coulomb: Vector3::zeros(),
            viscous: Vector3::zeros(),
            pulley: Vector4::zeros(),
        };
        for _ in 0..ROUNDS {
            (found.gains, found.gain_uncertainty) = self.gains(instruments, &found.pulley)?;
            self.refine(instruments, &mut found)?;
        }
        found.coulomb = found.coulomb.map(|friction| friction.max(0.0));
        Ok(found)
    }

    /// Returns the gains of the gauges if the pulleys have the friction `pulley`, and their relative uncertainty.
    fn gains(&self, instruments: &Instruments, pulley: &Vector4<f64>) -> Result<(Vector4<f64>, f64), Obstacle> {
        let rises: [Vector4<f64>; DIRECTIONS] = std::array::from_fn(|direction| {
            let level = |high: bool| {
                let of = |stroke: &Stroke| stroke.direction == direction && stroke.high == high;
                let mut strokes = self.strokes.iter().rev().filter(|(stroke, _)| of(stroke));
                // The last strokes of the two levels have the same speed.
                strokes.next().map_or_else(Vector4::zeros, |(stroke, averages)| {
                    let ways = at_joint(instruments, stroke, averages, pulley);
                    (ways[0] + ways[1]) * 0.5
                })
            };
            level(true) - level(false)
        });
        // The weights are the newtons per count of the gauges, relative to their mean. Factors on the newtons per count
        // whose weighted mean is 1 do not change the mean of the newtons per count.
        let weights = instruments.newton_per_count.abs();
        let weights = weights / weights.mean();
        let relative = |rise: &Vector4<f64>| {
            let gains = instruments.pretension.component_div(rise);
            gains / gains.component_mul(&weights).mean()
        };
        let gains = relative(&rises.iter().sum());
        // A single direction also determines all gains.
        let spread = rises.iter().map(|rise| (relative(rise).component_div(&gains)).add_scalar(-1.0).amax());
        let uncertainty = spread.fold(0.0, f64::max);
        let compared = gains / gains.mean();
        match compared.iter().position(|gain| !GAINS.contains(gain)) {
            Some(index) => {
                // The error has the gain as counts per newton, which is the reciprocal of the factor.
                let what = "the gain relative to the other gauges";
                Err(Obstacle::Implausible { part: Part::gauge(index), what, value: 1.0 / compared[index] })
            }
            None => Ok((gains, uncertainty)),
        }
    }

    /// Improves the friction by a Gauss-Newton step.
    fn refine(&self, instruments: &Instruments, found: &mut FreeFinger) -> Result<(), Obstacle> {
        let mut fit = LeastSquares::<10>::new();
        let r = &instruments.tendons.r;
        for (stroke, averages) in &self.strokes {
            let [back, forth] =
                at_joint(instruments, stroke, averages, &found.pulley).map(|t| t.component_mul(&found.gains));
            let signs = directions(instruments, stroke);
            // The derivative of `back - forth` with respect to mu.
            let slope = (forth + back).component_mul(&signs).zip_map(&found.pulley, |t, mu| t / (1.0 + mu));
            for joint in 0..3 {
                let row = r.row(joint).transpose();
                let sign = stroke.rates[joint].signum();
                let mut x = SVector::<f64, 10>::zeros();
                (x[joint], x[3 + joint]) = (sign, stroke.rates[joint]);
                let mut torque = 0.5 * row.dot(&(forth - back));
                for tendon in 0..4 {
                    let by_friction = 0.5 * row[tendon] * slope[tendon];
                    x[6 + tendon] = by_friction;
                    torque += by_friction * found.pulley[tendon];
                }
                fit.add(&x, torque);
            }
        }
        for joint in 0..3 {
            let mut x = SVector::<f64, 10>::zeros();
            x[3 + joint] = KNOWN;
            fit.add(&x, KNOWN * instruments.joint_viscous[joint]);
        }
        for tendon in 0..4 {
            let mut x = SVector::<f64, 10>::zeros();
            (x[6 + tendon], x[6 + (tendon + 1) % 4]) = (LIKENESS, -LIKENESS);
            fit.add(&x, 0.0);
        }
        let implausible = |part, what, value| Obstacle::Implausible { part, what, value };
        let (solution, _) =
            fit.solve().ok_or(implausible(Part::Finger, "the friction of joints and pulleys", f64::NAN))?;
        found.coulomb = solution.fixed_rows::<3>(0).into_owned();
        found.viscous = solution.fixed_rows::<3>(3).into_owned();
        let pulley = solution.fixed_rows::<4>(6).into_owned();
        if let Some(tendon) = pulley.iter().position(|friction| friction.abs() > LARGEST) {
            return Err(implausible(Part::tendon(tendon), "the friction of its pulleys", pulley[tendon]));
        }
        found.pulley = pulley.map(|friction| friction.max(0.0));
        Ok(())
    }
}

/// Returns the directions of the tendons in a motion forth: +1 toward the motor.
fn directions(instruments: &Instruments, stroke: &Stroke) -> Vector4<f64> {
    let speeds = instruments.tendons.r.tr_mul(&stroke.rates);
    let least = DIRECTED * speeds.amax();
    speeds.map(|speed| if speed.abs() > least { speed.signum() } else { 0.0 })
}

/// Returns the tensions at the joints, N, on the way back and on the way forth. The gains of the gauges are not
/// applied.
fn at_joint(
    instruments: &Instruments,
    stroke: &Stroke,
    averages: &[Average; 2],
    pulley: &Vector4<f64>,
) -> [Vector4<f64>; 2] {
    let forth = directions(instruments, stroke).zip_map(pulley, |sign, mu| (1.0 + mu).powf(-sign));
    [averages[0].mean().component_div(&forth), averages[1].mean().component_mul(&forth)]
}
