//! A hand as URDF: <https://docs.ros.org/en/rolling/Tutorials/Intermediate/URDF/URDF-Main.html>. URDF has no capsules,
//! so a capsule is a cylinder and two spheres.

use super::geometry::{Finger, Geometry, Link};
use super::shape::{Colour, Form, Shape};
use super::xml::{Attribute, Xml, metres, numbers};
use std::collections::BTreeSet;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};
use sun2xp::nalgebra::Vector3;

/// Returns the URDF of a hand.
pub fn urdf(geometry: &Geometry, configuration: &Configuration) -> String {
    let mut xml = Xml::new("Written by sun2xp model. Lengths are in m, masses in kg, angles in rad.");
    xml.open("robot", &[("name", &"sun2xp")]);
    // Without this element MuJoCo would merge each fingertip with the last link, because the tip does not move relative
    // to that link.
    xml.open("mujoco", &[]);
    xml.empty("compiler", &[("fusestatic", &"false"), ("discardvisual", &"false"), ("balanceinertia", &"false")]);
    xml.close();
    materials(&mut xml, geometry);
    xml.open("link", &[("name", &"palm")]);
    shapes(&mut xml, &geometry.palm);
    xml.close();
    for finger in &geometry.fingers {
        self::finger(&mut xml, finger, finger.configured(configuration));
    }
    xml.finish()
}

fn materials(xml: &mut Xml, geometry: &Geometry) {
    let links = geometry.fingers.iter().flat_map(|finger| &finger.links).flat_map(|link| &link.shapes);
    let bases = geometry.fingers.iter().flat_map(|finger| &finger.shapes);
    let colours: BTreeSet<[u8; 3]> = geometry.palm.iter().chain(bases).chain(links).map(|part| part.colour.0).collect();
    for colour in colours.into_iter().map(Colour) {
        xml.open("material", &[("name", &colour)]);
        xml.empty("color", &[("rgba", &numbers(colour.unit().into_iter().chain([1.0])))]);
        xml.close();
    }
}

fn finger(xml: &mut Xml, finger: &Finger, configured: &ConfiguredFinger) {
    let name = &finger.name;
    xml.open("link", &[("name", &format!("{name}_base"))]);
    shapes(xml, &finger.shapes);
    xml.close();
    fixed(xml, &format!("{name}_mount"), ["palm", &format!("{name}_base")], (finger.base, finger.turn));
    let mut parent = format!("{name}_base");
    for (index, link) in finger.links.iter().enumerate() {
        let child = format!("{name}_link{index}");
        xml.open("link", &[("name", &child)]);
        inertial(xml, link);
        shapes(xml, &link.shapes);
        xml.close();
        joint(xml, &format!("{name}_joint{index}"), [&parent, &child], finger, (configured, index));
        parent = child;
    }
    xml.empty("link", &[("name", &format!("{name}_tip"))]);
    fixed(xml, &format!("{name}_tip_mount"), [&parent, &format!("{name}_tip")], (finger.tip, 0.0));
}

fn fixed(xml: &mut Xml, name: &str, [parent, child]: [&str; 2], (position, turn): ([f64; 3], f64)) {
    xml.open("joint", &[("name", &name), ("type", &"fixed")]);
    xml.empty("parent", &[("link", &parent)]);
    xml.empty("child", &[("link", &child)]);
    xml.empty("origin", &[("xyz", &metres(position)), ("rpy", &numbers([0.0, 0.0, turn]))]);
    xml.close();
}

fn joint(
    xml: &mut Xml,
    name: &str,
    [parent, child]: [&str; 2],
    finger: &Finger,
    (configured, index): (&ConfiguredFinger, usize),
) {
    let Link { origin, axis, stops, limits, .. } = &finger.links[index];
    let simulation = &configured.simulation;
    xml.open("joint", &[("name", &name), ("type", &"revolute")]);
    xml.empty("parent", &[("link", &parent)]);
    xml.empty("child", &[("link", &child)]);
    xml.empty("origin", &[("xyz", &metres(*origin)), ("rpy", &"0 0 0")]);
    xml.empty("axis", &[("xyz", &numbers(*axis))]);
    let effort = largest_torque(&finger.r[index], configured);
    xml.empty(
        "limit",
        &[("lower", &stops[0]), ("upper", &stops[1]), ("effort", &effort), ("velocity", &configured.motion.speed)],
    );
    // The soft limits of the controller. The two gains of this element depend on the planner and are not known here. So
    // `k_velocity` is 0, and `k_position` is left out.
    let soft = [("soft_lower_limit", limits[0]), ("soft_upper_limit", limits[1]), ("k_velocity", 0.0)];
    let soft: Vec<Attribute> = soft.iter().map(|(key, value)| (*key, value as _)).collect();
    xml.empty("safety_controller", &soft);
    let (damping, friction) = (simulation.joint_viscous_friction[index], simulation.joint_coulomb_friction[index]);
    xml.empty("dynamics", &[("damping", &damping), ("friction", &friction)]);
    xml.close();
}

/// Returns the largest torque, N m, that the tendons can exert on a joint while all tensions are within their bounds.
/// `arms` are the moment arms of the joint, cm.
fn largest_torque(arms: &[f64; 4], finger: &ConfiguredFinger) -> f64 {
    let (least, most) = (finger.tendon.minimum, finger.tendon.maximum);
    let towards = |sign: f64| -> f64 {
        arms.iter().map(|arm| arm * sign * if arm * sign > 0.0 { most } else { least }).sum::<f64>()
    };
    towards(1.0).max(towards(-1.0)) / 100.0
}

fn inertial(xml: &mut Xml, link: &Link) {
    let [xx, yy, zz] = &link.inertia;
    xml.open("inertial", &[]);
    xml.empty("origin", &[("xyz", &metres(link.centre)), ("rpy", &"0 0 0")]);
    xml.empty("mass", &[("value", &link.mass)]);
    let none = &0;
    xml.empty("inertia", &[("ixx", xx), ("ixy", none), ("ixz", none), ("iyy", yy), ("iyz", none), ("izz", zz)]);
    xml.close();
}

fn shapes(xml: &mut Xml, shapes: &[Shape]) {
    for Shape { form, colour } in shapes {
        match *form {
            Form::Capsule { from, to, radius } => {
                cylinder(xml, from, to, radius, *colour);
                for centre in [from, to] {
                    sphere(xml, centre, radius, *colour);
                }
            }
            Form::Cylinder { from, to, radius } => cylinder(xml, from, to, radius, *colour),
            Form::Sphere { centre, radius } => sphere(xml, centre, radius, *colour),
            Form::Box { centre, size } => {
                part(xml, centre, [0.0; 3], *colour, |xml| xml.empty("box", &[("size", &metres(size))]));
            }
        }
    }
}

fn sphere(xml: &mut Xml, centre: [f64; 3], radius: f64, colour: Colour) {
    part(xml, centre, [0.0; 3], colour, |xml| xml.empty("sphere", &[("radius", &metres([radius]))]));
}

fn cylinder(xml: &mut Xml, from: [f64; 3], to: [f64; 3], radius: f64, colour: Colour) {
    let (from, to) = (Vector3::from(from), Vector3::from(to));
    let along = to - from;
    // Roll, pitch and yaw that turn the z axis into the axis of the cylinder.
    let turn = [0.0, along.xy().norm().atan2(along.z), along.y.atan2(along.x)];
    part(xml, ((from + to) / 2.0).into(), turn, colour, |xml| {
        xml.empty("cylinder", &[("radius", &metres([radius])), ("length", &metres([along.norm()]))]);
    });
}

/// Writes a visual shape, and the same shape for collisions.
fn part(xml: &mut Xml, centre: [f64; 3], turn: [f64; 3], colour: Colour, shape: impl Fn(&mut Xml)) {
    for purpose in ["visual", "collision"] {
        xml.open(purpose, &[]);
        xml.empty("origin", &[("xyz", &metres(centre)), ("rpy", &numbers(turn))]);
        xml.open("geometry", &[]);
        shape(xml);
        xml.close();
        if purpose == "visual" {
            xml.empty("material", &[("name", &colour)]);
        }
        xml.close();
    }
}
