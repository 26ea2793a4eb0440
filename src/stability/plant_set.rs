//! The set of plants for which a finger must be stable: the plant of the controller's model, and plants that differ
//! from it.

use crate::model::configuration::ConfiguredSimulation;

/// One in this many replies is lost: 5 %.
const LOSS_INTERVAL: usize = 20;

/// A plant that equals the controller's model or differs from it in one property, or a connection to the board that
/// loses replies.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// Name of the difference.
    pub name: &'static str,
    /// Changes the plant. The second argument is the period of the servo, ms.
    change: fn(&mut ConfiguredSimulation, f64),
    /// Of every `loss_interval` cycles, the last one loses its reply. With a `loss_interval` of 0, no reply is lost.
    pub(super) loss_interval: usize,
}

impl Variant {
    /// The plant of the controller's model.
    pub const NOMINAL: Self = Self::new("nominal", |_, _| {});

    /// The set of plants. The nominal plant is the first.
    pub const SET: [Self; 17] = [
        Self::NOMINAL,
        Self::new("rotor inertia x0.5", |plant, _| scale(&mut plant.rotor_inertia, 0.5)),
        Self::new("rotor inertia x1.5", |plant, _| scale(&mut plant.rotor_inertia, 1.5)),
        Self::new("rotor inertia x2", |plant, _| scale(&mut plant.rotor_inertia, 2.0)),
        Self::new("links x0.5", |plant, _| scale(&mut plant.masses, 0.5)),
        Self::new("links x2", |plant, _| scale(&mut plant.masses, 2.0)),
        Self::new("tendon stiffness x0.7", |plant, _| scale(&mut plant.tendon_stiffness, 0.7)),
        Self::new("tendon stiffness x1.3", |plant, _| scale(&mut plant.tendon_stiffness, 1.3)),
        Self::new("motor constants x0.8", |plant, _| scale(&mut plant.motor_constant_ratio, 0.8)),
        Self::new("motor constants x1.2", |plant, _| scale(&mut plant.motor_constant_ratio, 1.2)),
        Self::new("motor constants alternately x1.2 and x0.8", |plant, _| {
            plant.motor_constant_ratio = [1.2, 0.8, 1.2, 0.8];
        }),
        Self::new("amplifier lag 1 ms", |plant, _| plant.amplifier_lag_ms = 1.0),
        Self::new("amplifier lag 2 ms", |plant, _| plant.amplifier_lag_ms = 2.0),
        Self::new("extra cycle of delay", |plant, period| plant.command_delay_ms = period),
        Self::new("held mass 0.1 kg", |plant, _| plant.held_mass = 0.1),
        Self::new("held mass 0.3 kg", |plant, _| plant.held_mass = 0.3),
        Self { name: "every 20th reply lost", change: |_, _| {}, loss_interval: LOSS_INTERVAL },
    ];

    const fn new(name: &'static str, change: fn(&mut ConfiguredSimulation, f64)) -> Self {
        Self { name, change, loss_interval: 0 }
    }

    /// Changes the parameters of a plant that equals the controller's model. `rate` is that of the servo, Hz.
    pub(super) fn apply(&self, plant: &mut ConfiguredSimulation, rate: f64) {
        (self.change)(plant, 1000.0 / rate);
    }
}

fn scale(values: &mut [f64; 4], factor: f64) {
    values.iter_mut().for_each(|value| *value *= factor);
}
