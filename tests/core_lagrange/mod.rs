//! A second model of a frictionless finger. The kinetic energy of the links is summed over points with the mass and the
//! second moments of the links. Lagrange's equations follow by numeric differentiation. This model shares no code with
//! the plant.

use nalgebra::{Matrix3, Rotation3, SVector, Vector3, Vector4};

const LENGTHS: [f64; 3] = [0.03556, 0.05080, 0.04000];
const RADII: [f64; 3] = [0.009, 0.008, 0.007];
const MASSES: [f64; 4] = [0.060, 0.045, 0.025, 0.005];
const MOTOR_RADIUS: f64 = 0.0475e-2;
const TENDON_STIFFNESS: f64 = 3e4;
const ROTOR: f64 = 6e-7;
const R: [[f64; 4]; 3] =
    [[-0.0109, 0.0062, 0.0062, -0.0109], [0.0109, 0.0062, -0.0062, -0.0109], [0.0, 0.0062, -0.0062, 0.0]];

type State = SVector<f64, 14>;

pub struct IndependentFinger {
    state: State,
    gravity: Vector3<f64>,
    force: Vector3<f64>,
    torque: [f64; 4],
    home_tension: [f64; 4],
}

impl IndependentFinger {
    /// A finger at rest at the pose, degrees, with a least tension of 5 N and no joint torque.
    pub fn new(pose: [f64; 3], gravity: Vector3<f64>, force: Vector3<f64>, torque: [f64; 4]) -> Self {
        // Without joint torque, row 3 of R makes the tensions of tendons 2 and 3 equal. Then rows 1 and 2 make those of
        // tendons 1 and 4 equal, and 2 * 0.62 t2 = 2 * 1.09 t1.
        let home_tension = [5.0, 5.0 * 1.09 / 0.62, 5.0 * 1.09 / 0.62, 5.0];
        let theta = Vector3::from(pose.map(f64::to_radians));
        let mut state = State::zeros();
        state.fixed_rows_mut::<3>(0).copy_from(&theta);
        for tendon in 0..4 {
            state[3 + tendon] = (0..3).map(|joint| R[joint][tendon] * theta[joint]).sum::<f64>() / MOTOR_RADIUS;
        }
        Self { state, gravity, force, torque, home_tension }
    }

    /// Changes the force on the tip, N.
    pub fn push(&mut self, force: Vector3<f64>) {
        self.force = force;
    }

    /// The tensions of the tendons, N.
    pub fn tensions(&self) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| self.tension(&self.state, tendon))
    }

    pub fn joints(&self) -> Vector3<f64> {
        self.state.fixed_rows::<3>(0).into_owned()
    }

    pub fn motors(&self) -> Vector4<f64> {
        self.state.fixed_rows::<4>(3).into_owned()
    }

    /// One step of the classical Runge-Kutta method.
    pub fn step(&mut self, h: f64) {
        let a = self.derivative(&self.state);
        let b = self.derivative(&(self.state + a * (h / 2.0)));
        let c = self.derivative(&(self.state + b * (h / 2.0)));
        let d = self.derivative(&(self.state + c * h));
        self.state += (a + (b + c) * 2.0 + d) * (h / 6.0);
    }

    fn tension(&self, state: &State, tendon: usize) -> f64 {
        let wrapped: f64 = (0..3).map(|joint| R[joint][tendon] * state[joint]).sum();
        (TENDON_STIFFNESS * (MOTOR_RADIUS * state[3 + tendon] - wrapped) + self.home_tension[tendon]).max(0.0)
    }

    fn derivative(&self, state: &State) -> State {
        let theta: Vector3<f64> = state.fixed_rows::<3>(0).into_owned();
        let rate: Vector3<f64> = state.fixed_rows::<3>(7).into_owned();
        let mut joint_torque = Vector3::zeros();
        let mut derivative = State::zeros();
        for tendon in 0..4 {
            let tension = self.tension(state, tendon);
            for joint in 0..3 {
                joint_torque[joint] += R[joint][tendon] * tension;
            }
            derivative[10 + tendon] = (self.torque[tendon] - MOTOR_RADIUS * tension) / ROTOR;
        }
        // d/dt (dT/d rate) - dT/d theta = Q, with T = rate' H(theta) rate / 2.
        let inertia = inertia(&theta);
        let mut right = joint_torque;
        for joint in 0..3 {
            let slope = 1e-5;
            let mut step = Vector3::zeros();
            step[joint] = slope;
            let by_joint = (self::inertia(&(theta + step)) - self::inertia(&(theta - step))) / (2.0 * slope);
            right -= by_joint * rate * rate[joint];
            right[joint] += 0.5 * rate.dot(&(by_joint * rate));
            let work = |at: Vector3<f64>| {
                let tip = points(&at).last().unwrap().1;
                let falling: f64 = points(&at).iter().map(|(mass, place)| mass * self.gravity.dot(place)).sum();
                falling + self.force.dot(&tip)
            };
            right[joint] += (work(theta + step) - work(theta - step)) / (2.0 * slope);
        }
        derivative.fixed_rows_mut::<3>(0).copy_from(&rate);
        derivative.fixed_rows_mut::<4>(3).copy_from(&state.fixed_rows::<4>(10));
        derivative.fixed_rows_mut::<3>(7).copy_from(&inertia.lu().solve(&right).unwrap());
        derivative
    }
}

/// The matrix H of the kinetic energy T = rate' H rate / 2: the sum of m (dp/dtheta)' (dp/dtheta) over the points.
fn inertia(theta: &Vector3<f64>) -> Matrix3<f64> {
    let slope = 1e-4;
    let mut moved = Vec::new();
    for joint in 0..3 {
        let mut step = Vector3::zeros();
        step[joint] = slope;
        moved.push((points(&(theta + step)), points(&(theta - step))));
    }
    let velocity = |joint: usize, point: usize| (moved[joint].0[point].1 - moved[joint].1[point].1) / (2.0 * slope);
    let mut h = Matrix3::zeros();
    for (point, (mass, _)) in points(theta).iter().enumerate() {
        for row in 0..3 {
            for column in 0..3 {
                h[(row, column)] += mass * velocity(row, point).dot(&velocity(column, point));
            }
        }
    }
    h
}

/// Each link has eight points: at both places of Gauss's two-point rule on its axis, four points around the axis at the
/// distance radius / sqrt 2. They have the mass, the centre and the second moments of a uniform cylinder. The tip is
/// the last point.
fn points(theta: &Vector3<f64>) -> Vec<(f64, Vector3<f64>)> {
    let mut turn = Rotation3::identity();
    let mut origin = Vector3::zeros();
    let mut points = Vec::with_capacity(25);
    for link in 0..3 {
        let axis = if link == 0 { Vector3::y_axis() } else { Vector3::x_axis() };
        turn *= Rotation3::from_axis_angle(&axis, theta[link]);
        for place in [0.5 - 0.5 / 3f64.sqrt(), 0.5 + 0.5 / 3f64.sqrt()] {
            for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                let radius = RADII[link] / 2f64.sqrt();
                let local = Vector3::new(radius * x, radius * y, LENGTHS[link] * place);
                points.push((MASSES[link] / 8.0, origin + turn * local));
            }
        }
        origin += turn * Vector3::new(0.0, 0.0, LENGTHS[link]);
    }
    points.push((MASSES[3], origin));
    points
}
