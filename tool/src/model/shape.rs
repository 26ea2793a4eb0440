//! The shapes from which a hand is drawn. Lengths are in cm.

use serde::{Serialize, Serializer};
use std::fmt;
use sun2xp::model::FingerNumber;

/// A shape with a colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shape {
    /// Its form and place.
    #[serde(flatten)]
    pub form: Form,
    /// Its colour.
    pub colour: Colour,
}

/// The form of a shape and its place in the frame of its link.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "form", rename_all = "snake_case")]
pub enum Form {
    /// A cylinder with round ends. The ends of its axis are the centres of the hemispheres.
    Capsule {
        /// One end of the axis.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// A cylinder with flat ends.
    Cylinder {
        /// One end of the axis.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// A sphere.
    Sphere {
        /// Centre.
        centre: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// A box whose edges are parallel to the axes.
    Box {
        /// Centre.
        centre: [f64; 3],
        /// Lengths of the edges.
        size: [f64; 3],
    },
}

/// A colour: red, green and blue. In JSON it is `#rrggbb`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour(pub [u8; 3]);

impl Colour {
    /// The palm.
    pub const PALM: Self = Self([0x5a, 0x65, 0x78]);
    /// The wrist and the bases of the fingers.
    pub const BASE: Self = Self([0x3b, 0x42, 0x52]);
    /// The pulleys and shafts of the joints, and the flange of the wrist.
    pub const JOINT: Self = Self([0x8a, 0x93, 0xa3]);
    /// The rubber of the fingertips.
    pub const TIP: Self = Self([0x2e, 0x33, 0x3d]);
    /// The object of the simulation.
    pub const OBJECT: Self = Self([0xe8, 0xc5, 0x6b]);

    /// Returns the colour of a finger's links.
    pub fn of_finger(finger: FingerNumber) -> Self {
        // Similar to the blue, orange and green of Okabe and Ito, which people with any colour vision can distinguish.
        Self([[0x56, 0xa5, 0xe0], [0xe6, 0x9f, 0x3c], [0x2b, 0xb0, 0x8c]][finger.index()])
    }

    /// Returns red, green and blue, 0 to 1.
    pub fn unit(&self) -> [f64; 3] {
        self.0.map(|part| f64::from(part) / 255.0)
    }
}

impl Serialize for Colour {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let [red, green, blue] = self.0;
        write!(formatter, "#{red:02x}{green:02x}{blue:02x}")
    }
}

impl Shape {
    /// Constructs a capsule.
    pub fn capsule(from: [f64; 3], to: [f64; 3], radius: f64, colour: Colour) -> Self {
        Self { form: Form::Capsule { from, to, radius }, colour }
    }

    /// Constructs a cylinder.
    pub fn cylinder(from: [f64; 3], to: [f64; 3], radius: f64, colour: Colour) -> Self {
        Self { form: Form::Cylinder { from, to, radius }, colour }
    }

    /// Constructs a sphere.
    pub fn sphere(centre: [f64; 3], radius: f64, colour: Colour) -> Self {
        Self { form: Form::Sphere { centre, radius }, colour }
    }

    /// Constructs a box.
    pub fn block(centre: [f64; 3], size: [f64; 3], colour: Colour) -> Self {
        Self { form: Form::Box { centre, size }, colour }
    }
}
