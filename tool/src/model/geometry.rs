//! The geometry of a configured hand: the one description from which the files for other programs and the drawing of
//! the web page are made.
//!
//! Lengths are in cm, angles in rad, masses in kg and moments of inertia in kg m^2. The palm's frame is the frame of
//! the hand. A link's frame has its origin on the link's joint and its z axis along the link. At joint angle zero, its
//! axes are parallel to those of the parent link's frame. The frame of link 0 is then the finger's frame (Figure 8 of
//! the report).

use super::palm;
use super::shape::{Colour, Shape};
use serde::Serialize;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, ConfiguredObject, ObjectShape};
use sun2xp::model::direction;
use sun2xp::nalgebra::{Matrix3x4, Vector3};

/// Axes of the joints 0, 1 and 2 in the frames of their links.
const AXES: [[f64; 3]; 3] = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];

/// Radius of the drawn fingertip divided by the radius of the last link.
const TIP_RATIO: f64 = 0.85;

/// A hand with its fingers and its object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Geometry {
    /// The palm, in the palm's frame.
    pub palm: Vec<Shape>,
    /// The fingers that the hand has (`hand.fingers`).
    pub fingers: Vec<Finger>,
    /// The object of the simulated hand.
    pub object: Option<Object>,
    /// Gravity in the palm's frame, m/s^2.
    pub gravity: [f64; 3],
}

/// A finger: a base that is fixed to the palm, and three links.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finger {
    /// 1 to 3.
    pub number: FingerNumber,
    /// `finger1` to `finger3`.
    pub name: String,
    /// Position of the base in the palm's frame.
    pub base: [f64; 3],
    /// Rotation of the finger's frame about the palm's z axis.
    pub turn: f64,
    /// The parts of the base, in the finger's frame.
    pub shapes: Vec<Shape>,
    /// Links 0, 1 and 2, each with the joint that moves it.
    pub links: [Link; 3],
    /// Position of the fingertip in the frame of link 2.
    pub tip: [f64; 3],
    /// Moment arms of the tendons: rows are joints, and columns are tendons.
    pub r: [[f64; 4]; 3],
    /// Joint angles at the start of the simulation.
    pub start: [f64; 3],
}

/// A link and the joint between it and its parent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Link {
    /// Position of the joint in the frame of the parent.
    pub origin: [f64; 3],
    /// Axis of the joint.
    pub axis: [f64; 3],
    /// Soft limits of the joint: lower, upper.
    pub limits: [f64; 2],
    /// Mechanical stops of the joint: lower, upper.
    pub stops: [f64; 2],
    /// Length of the link.
    pub length: f64,
    /// The parts of the link, in its frame.
    pub shapes: Vec<Shape>,
    /// Mass of the link. For link 2 it includes the tip and what the tip holds.
    pub mass: f64,
    /// Centre of mass in the frame of the link.
    pub centre: [f64; 3],
    /// Moments of inertia about axes through the centre of mass that are parallel to those of the link's frame.
    pub inertia: [f64; 3],
}

/// The object that all fingers of a simulated hand can touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Object {
    /// Its shape, with the middle at the origin.
    pub shape: Shape,
    /// Position of its middle at the start, in the palm's frame.
    pub position: [f64; 3],
    /// Its mass.
    pub mass: f64,
    /// Its moments of inertia.
    pub inertia: [f64; 3],
    /// Coefficient of friction.
    pub friction: f64,
    /// The table on which it may lie.
    pub table: Option<Table>,
}

/// A plane in the palm's frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Table {
    /// Unit normal of the plane. It points to the side on which the object is.
    pub up: [f64; 3],
    /// A point of the plane.
    pub point: [f64; 3],
}

/// Returns the geometry of a hand. Masses, moment arms and stops are those of the simulated hand.
pub fn geometry(configuration: &Configuration) -> Geometry {
    let fingers: Vec<Finger> =
        configuration.hand.fingers.members().map(|number| finger(configuration, number)).collect();
    Geometry {
        palm: palm::shapes(&fingers),
        fingers,
        object: configuration.hand.simulated_object.as_ref().map(|object| self::object(object, configuration)),
        gravity: configuration.hand.gravity,
    }
}

impl Finger {
    /// The configuration of this finger.
    pub fn configured<'a>(&self, configuration: &'a Configuration) -> &'a ConfiguredFinger {
        &configuration.fingers[self.number.index()]
    }
}

fn finger(configuration: &Configuration, number: FingerNumber) -> Finger {
    let configured = &configuration.fingers[number.index()];
    let in_palm = configuration.finger_to_palm(number);
    let [_, _, last] = configured.geometry.links;
    let ratios = &configured.simulation.moment_arm_ratio;
    let r = Matrix3x4::from_fn(|joint, tendon| configured.geometry.r[joint][tendon] * ratios[joint][tendon]);
    Finger {
        number,
        name: format!("finger{number}"),
        base: in_palm.translation.vector.into(),
        // The rotation of a finger in the palm is about z.
        turn: in_palm.rotation.scaled_axis().z,
        shapes: palm::base(configured.simulation.link_radii[0] * 100.0),
        links: [0, 1, 2].map(|index| link(configured, number, index)),
        tip: [0.0, 0.0, last],
        r: std::array::from_fn(|joint| std::array::from_fn(|tendon| r[(joint, tendon)])),
        start: configured.simulation.start_degrees.map(f64::to_radians),
    }
}

fn link(finger: &ConfiguredFinger, number: FingerNumber, index: usize) -> Link {
    let simulation = &finger.simulation;
    let length = finger.geometry.links[index];
    let radius = simulation.link_radii[index] * 100.0;
    let (lower, upper) = finger.joint_limits();
    let margin = simulation.stop_margin_degrees.to_radians();
    let colour = Colour::of_finger(number);
    let along = |z: f64| [0.0, 0.0, z];
    let mut shapes = vec![Shape::capsule(along(0.0), along(length), radius, colour)];
    if index < 2 {
        // The pulleys of the next joint, a little wider than the link.
        let half = radius * 1.2;
        shapes.push(Shape::cylinder([-half, 0.0, length], [half, 0.0, length], radius * 0.8, Colour::JOINT));
    } else {
        let tip = radius * TIP_RATIO;
        shapes[0] = Shape::capsule(along(0.0), along((length - tip).max(length / 10.0)), radius * 0.9, colour);
        shapes.push(Shape::sphere(along(length), tip, Colour::TIP));
    }
    let body = body(finger, index);
    Link {
        origin: along(if index == 0 { 0.0 } else { finger.geometry.links[index - 1] }),
        axis: AXES[index],
        limits: [lower[index], upper[index]],
        stops: [lower[index] - margin, upper[index] + margin],
        length,
        shapes,
        mass: body.mass,
        centre: along(body.centre * 100.0),
        inertia: [body.transverse, body.transverse, body.axial],
    }
}

/// A link as a rigid body, SI units.
struct Body {
    mass: f64,
    /// Distance of the centre of mass from the joint.
    centre: f64,
    transverse: f64,
    axial: f64,
}

/// Returns the rigid body of a link: a uniform cylinder, and at the end of the last link the point mass of the tip and
/// of what it holds.
fn body(finger: &ConfiguredFinger, index: usize) -> Body {
    let simulation = &finger.simulation;
    let (mass, radius) = (simulation.masses[index], simulation.link_radii[index]);
    let length = finger.geometry.links[index] * 0.01;
    let axial = mass * radius * radius / 2.0;
    let transverse = axial / 2.0 + mass * length * length / 12.0;
    let tip = if index == 2 { simulation.masses[3] + simulation.held_mass } else { 0.0 };
    let total = mass + tip;
    // The centres of the two masses are half the length apart. Their parallel-axis terms add up to the reduced mass
    // times the square of this distance.
    let spread = mass * tip / total * (length / 2.0).powi(2);
    Body { mass: total, centre: (mass * length / 2.0 + tip * length) / total, transverse: transverse + spread, axial }
}

fn object(object: &ConfiguredObject, configuration: &Configuration) -> Object {
    let mass = object.mass;
    let square = |cm: f64| (cm * 0.01).powi(2);
    let (shape, inertia) = match object.shape {
        ObjectShape::Ball { radius } => {
            (Shape::sphere([0.0; 3], radius, Colour::OBJECT), [0.4 * mass * square(radius); 3])
        }
        ObjectShape::Box { size } => {
            let [x, y, z] = size.map(square);
            let inertia = [y + z, x + z, x + y].map(|sum| sum * mass / 12.0);
            (Shape::block([0.0; 3], size, Colour::OBJECT), inertia)
        }
        _ => unreachable!("the shapes of an object are balls and boxes"),
    };
    let down = direction(&Vector3::from(configuration.hand.gravity)).unwrap_or_else(Vector3::z);
    Object {
        shape,
        position: object.position,
        mass,
        inertia,
        friction: object.friction,
        table: object.table.map(|distance| Table { up: (-down).into(), point: (down * distance).into() }),
    }
}
