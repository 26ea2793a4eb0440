//! The four tendons: one-sided springs between the motor pulleys and the joints. The tendons may rub, harden and creep.

use super::capstan::{Capstans, Contacts, SectionTensions};
use super::elasticity::Elasticity;
use crate::model::TendonsError;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::{Matrix3x4, Vector3, Vector4};

/// Springs with the stretch r m - R^T theta + home stretch, less the lengths that slipping and creep have added. r are
/// the radii of the motor pulleys, and m the motor angles. The motor angles are zero at theta = 0 with the homing
/// pretension.
#[derive(Clone, Debug)]
pub(super) struct ElasticTendons {
    /// R, m.
    r: Matrix3x4<f64>,
    /// Radii of the motor pulleys, m.
    pub radius: Vector4<f64>,
    elasticity: [Elasticity; 4],
    /// Friction in conduits and on pulleys, if there is any.
    friction: Option<Capstans>,
    /// Contacts of the tendons with conduits and pulleys, if there is friction.
    contacts: [Contacts; 4],
    /// Stretch at motor angle zero and theta = 0 of tendons that have neither slipped nor crept, m.
    home_stretch: Vector4<f64>,
    /// Torn tendons, which have no tension.
    cut: [bool; 4],
    /// Tension above which each tendon slips in its clamp, N. It is infinite for a tendon that cannot slip.
    grip: Vector4<f64>,
    /// Length that slipping has added to each tendon, m.
    slipped: Vector4<f64>,
    /// Length that creep adds in the long run, divided by the elastic stretch.
    creep: f64,
    /// Time constant of the creep, s.
    creep_time: f64,
    /// Length that creep has added to each tendon, m.
    crept: Vector4<f64>,
}

/// The tensions of the four tendons in their three sections, N.
#[derive(Clone, Copy, Debug)]
pub(super) struct TendonTensions {
    /// At the motor, before the friction of the conduit.
    pub motor: Vector4<f64>,
    /// At the gauge.
    pub gauge: Vector4<f64>,
    /// At the joint, after the friction of the pulleys.
    pub joint: Vector4<f64>,
}

impl ElasticTendons {
    /// Constructs tendons with the joints at `theta`, rad, and the homing pretension in every section.
    pub fn new(finger: &ConfiguredFinger, theta: &Vector3<f64>) -> Result<Self, TendonsError> {
        let tendons = finger.true_tendons()?;
        let simulation = &finger.simulation;
        let stiffness = Vector4::from(simulation.tendon_stiffness) * 100.0;
        let elasticity: [Elasticity; 4] = std::array::from_fn(|tendon| {
            Elasticity::new(stiffness[tendon], simulation.hardening, finger.tendon.maximum)
        });
        let home = tendons.pretension(finger.tendon.minimum);
        let mut this = Self {
            r: tendons.r * 0.01,
            radius: tendons.radius * 0.01,
            home_stretch: Vector4::from_fn(|tendon, _| elasticity[tendon].stretch(home[tendon])),
            elasticity,
            friction: Capstans::new(simulation.conduit_friction, simulation.pulley_friction),
            contacts: Default::default(),
            cut: [false; 4],
            grip: Vector4::repeat(f64::INFINITY),
            slipped: Vector4::zeros(),
            creep: simulation.creep,
            creep_time: simulation.creep_time,
            crept: Vector4::zeros(),
        };
        let motor = this.motor_angles_at(theta);
        this.contacts = std::array::from_fn(|tendon| {
            let (motor, joint) = this.ends(tendon, theta, &motor);
            Capstans::relaxed(motor + this.rest_stretch(tendon), joint)
        });
        this.crept = this.lasting_creep(theta, &motor);
        this.home_stretch += this.crept;
        Ok(this)
    }

    /// Lets the tendons creep and slip for `seconds` at these joint and motor angles, rad.
    pub fn lengthen(&mut self, theta: &Vector3<f64>, motor: &Vector4<f64>, seconds: f64) {
        if self.creep > 0.0 {
            self.crept += (self.lasting_creep(theta, motor) - self.crept) * (seconds / self.creep_time);
        }
        self.slip(theta, motor);
    }

    /// Lets the tendons slide in their conduits and on their pulleys, as far as these angles, rad, force them to.
    pub fn slide(&mut self, theta: &Vector3<f64>, motor: &Vector4<f64>) {
        let Some(friction) = self.friction else { return };
        for tendon in 0..4 {
            let (motor, joint) = self.ends(tendon, theta, motor);
            let wound = motor + self.rest_stretch(tendon);
            friction.slide(&mut self.contacts[tendon], &self.elasticity[tendon], wound, joint);
        }
    }

    /// Returns the tensions at joint angles and motor angles, rad. The tension of a slack tendon is zero.
    pub fn tensions(&self, theta: &Vector3<f64>, motor: &Vector4<f64>) -> TendonTensions {
        let sections: [SectionTensions; 4] = std::array::from_fn(|tendon| self.sections(tendon, theta, motor));
        let of = |part: fn(&SectionTensions) -> f64| Vector4::from_fn(|tendon, _| part(&sections[tendon]));
        TendonTensions {
            motor: of(|tension| tension.motor),
            gauge: of(|tension| tension.gauge),
            joint: of(|tension| tension.joint),
        }
    }

    /// Tears a tendon, 0 to 3.
    pub fn cut(&mut self, tendon: usize) {
        self.cut[tendon] = true;
    }

    /// Loosens the clamp of a tendon, 0 to 3. From now on the tendon slips at tensions above `grip`, N.
    pub fn loosen(&mut self, tendon: usize, grip: f64) {
        self.grip[tendon] = grip;
    }

    /// Repairs torn and slipping tendons.
    pub fn restore(&mut self) {
        self.cut = [false; 4];
        self.grip = Vector4::repeat(f64::INFINITY);
        self.slipped = Vector4::zeros();
    }

    /// Returns tau = R t, eq. 13, N m, from the tensions at the joints, N.
    pub fn joint_torque(&self, tensions: &Vector4<f64>) -> Vector3<f64> {
        self.r * tensions
    }

    /// Returns the motor angles, rad, at which the finger has the joint angles `theta` with the homing pretension.
    pub fn motor_angles_at(&self, theta: &Vector3<f64>) -> Vector4<f64> {
        self.r.tr_mul(theta).component_div(&self.radius)
    }

    /// Returns the elastic energy, J.
    pub fn energy(&self, theta: &Vector3<f64>, motor: &Vector4<f64>) -> f64 {
        let of = |tendon: usize| {
            let (motor, joint) = self.ends(tendon, theta, motor);
            let elasticity = &self.elasticity[tendon];
            match self.friction {
                _ if self.cut[tendon] => 0.0,
                Some(_) => self.contacts[tendon].energy(elasticity, motor + self.rest_stretch(tendon), joint),
                None => elasticity.energy(motor - joint + self.rest_stretch(tendon)),
            }
        };
        (0..4).map(of).sum()
    }

    /// Makes each tendon slip if its tension exceeds its grip.
    fn slip(&mut self, theta: &Vector3<f64>, motor: &Vector4<f64>) {
        if self.grip.min() == f64::INFINITY {
            return;
        }
        let tensions = self.tensions(theta, motor).gauge;
        for tendon in 0..4 {
            let beyond = (tensions[tendon] - self.grip[tendon]).max(0.0);
            self.slipped[tendon] += beyond / self.elasticity[tendon].local_stiffness(tensions[tendon]);
        }
    }

    /// Returns the length that creep adds in the long run at the present stretch, m.
    fn lasting_creep(&self, theta: &Vector3<f64>, motor: &Vector4<f64>) -> Vector4<f64> {
        let tensions = self.tensions(theta, motor).gauge;
        Vector4::from_fn(|tendon, _| self.creep * self.elasticity[tendon].stretch(tensions[tendon]))
    }

    fn sections(&self, tendon: usize, theta: &Vector3<f64>, motor: &Vector4<f64>) -> SectionTensions {
        let elasticity = &self.elasticity[tendon];
        let (wound, joint) = self.ends(tendon, theta, motor);
        match self.friction {
            _ if self.cut[tendon] => SectionTensions { motor: 0.0, gauge: 0.0, joint: 0.0 },
            Some(_) => self.contacts[tendon].tensions(elasticity, wound + self.rest_stretch(tendon), joint),
            None => {
                let tension = elasticity.tension(wound - joint + self.rest_stretch(tendon));
                SectionTensions { motor: tension, gauge: tension, joint: tension }
            }
        }
    }

    /// Returns how far the motor has wound a tendon in, and how far the joints have moved the tendon's other end toward
    /// the motor, m.
    fn ends(&self, tendon: usize, theta: &Vector3<f64>, motor: &Vector4<f64>) -> (f64, f64) {
        (self.radius[tendon] * motor[tendon], self.r.column(tendon).dot(theta))
    }

    /// Returns the stretch of a tendon at motor angle zero and theta = 0, m. Slipping and creep have reduced it.
    fn rest_stretch(&self, tendon: usize) -> f64 {
        self.home_stretch[tendon] - self.slipped[tendon] - self.crept[tendon]
    }
}
