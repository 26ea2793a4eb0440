//! A hand as MJCF, the format of MuJoCo: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>. Each tendon is an
//! element `fixed`: a linear combination of joint angles, whose coefficients are the moment arms R. The controls are
//! the tensions t, N. So they cause the joint torques R t (eq. 13).

use super::geometry::{Finger, Geometry, Link, Object};
use super::shape::{Form, Shape};
use super::xml::{Attribute, Xml, metres, numbers};
use std::fmt::Display;
use sun2xp::model::TendonsError;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};

/// Radius of the ball that stands for the contact point of a fingertip, cm. The simulated tip is a point.
const CONTACT_RADIUS: f64 = 0.1;

/// Returns the MJCF of a hand.
///
/// # Errors
/// Returns an error if the tendons with their true moment arms cannot hold the finger.
pub fn mjcf(geometry: &Geometry, configuration: &Configuration) -> Result<String, TendonsError> {
    let mut xml = Xml::new("Written by sun2xp model. Lengths are in m, masses in kg, angles in rad, forces in N.");
    xml.open("mujoco", &[("model", &"sun2xp")]);
    xml.empty("compiler", &[("angle", &"radian"), ("autolimits", &"true")]);
    let gravity = numbers(geometry.gravity);
    xml.empty("option", &[("gravity", &gravity), ("timestep", &0.001), ("integrator", &"implicitfast")]);
    looks(&mut xml);
    xml.open("worldbody", &[]);
    surroundings(&mut xml);
    xml.open("body", &[("name", &"palm")]);
    shapes(&mut xml, &geometry.palm);
    for finger in &geometry.fingers {
        self::finger(&mut xml, finger, finger.configured(configuration));
    }
    xml.close();
    if let Some(object) = &geometry.object {
        self::object(&mut xml, object);
    }
    xml.close();
    tendons(&mut xml, geometry, configuration);
    start(&mut xml, geometry, configuration)?;
    Ok(xml.finish())
}

fn looks(xml: &mut Xml) {
    xml.open("visual", &[]);
    xml.empty("global", &[("offwidth", &1920), ("offheight", &1440), ("azimuth", &150), ("elevation", &-20)]);
    xml.empty("headlight", &[("ambient", &"0.35 0.35 0.35"), ("diffuse", &"0.45 0.45 0.45")]);
    xml.empty("quality", &[("shadowsize", &4096)]);
    xml.close();
    xml.empty("statistic", &[("center", &"0 0 0.04"), ("extent", &0.16)]);
    xml.open("asset", &[]);
    let sky: [Attribute; 6] = [
        ("type", &"skybox"),
        ("builtin", &"gradient"),
        ("rgb1", &"0.93 0.95 0.97"),
        ("rgb2", &"0.62 0.69 0.77"),
        ("width", &64),
        ("height", &512),
    ];
    xml.empty("texture", &sky);
    xml.close();
}

fn surroundings(xml: &mut Xml) {
    let light = ("diffuse", &"0.55 0.55 0.55" as _);
    xml.empty("light", &[("pos", &"0.3 -0.4 0.6"), ("dir", &"-0.4 0.5 -0.8"), ("directional", &"true"), light]);
    let camera: [Attribute; 4] = [
        ("name", &"view"),
        ("pos", &"0.285 -0.238 0.165"),
        ("xyaxes", &"0.640 0.768 0 -0.281 0.234 0.931"),
        ("fovy", &32),
    ];
    xml.empty("camera", &camera);
}

fn finger(xml: &mut Xml, finger: &Finger, configured: &ConfiguredFinger) {
    let name = &finger.name;
    let turn = numbers([0.0, 0.0, 1.0, finger.turn]);
    xml.open("body", &[("name", &format!("{name}_base")), ("pos", &metres(finger.base)), ("axisangle", &turn)]);
    shapes(xml, &finger.shapes);
    for (index, link) in finger.links.iter().enumerate() {
        xml.open("body", &[("name", &format!("{name}_link{index}")), ("pos", &metres(link.origin))]);
        xml.empty(
            "inertial",
            &[("pos", &metres(link.centre)), ("mass", &link.mass), ("diaginertia", &numbers(link.inertia))],
        );
        joint(xml, &format!("{name}_joint{index}"), link, (configured, index));
        shapes(xml, &link.shapes);
    }
    let at = metres(finger.tip);
    xml.empty("site", &[("name", &format!("{name}_tip")), ("pos", &at), ("size", &metres([0.2])), ("group", &4)]);
    let contact: [Attribute; 8] = [
        ("name", &format!("{name}_contact")),
        ("type", &"sphere"),
        ("pos", &at),
        ("size", &metres([CONTACT_RADIUS])),
        ("mass", &0),
        ("contype", &1),
        ("conaffinity", &0),
        ("group", &3),
    ];
    xml.empty("geom", &contact);
    for _ in 0..4 {
        xml.close();
    }
}

fn joint(xml: &mut Xml, name: &str, link: &Link, (configured, index): (&ConfiguredFinger, usize)) {
    let simulation = &configured.simulation;
    let joint: [Attribute; 6] = [
        ("name", &name),
        ("type", &"hinge"),
        ("axis", &numbers(link.axis)),
        ("range", &numbers(link.stops)),
        ("damping", &simulation.joint_viscous_friction[index]),
        ("frictionloss", &simulation.joint_coulomb_friction[index]),
    ];
    xml.empty("joint", &joint);
}

/// Writes shapes that touch nothing and weigh nothing.
fn shapes(xml: &mut Xml, shapes: &[Shape]) {
    for shape in shapes {
        let (kind, place) = form(&shape.form);
        let colour = numbers(shape.colour.unit().into_iter().chain([1.0]));
        let mut attributes: Vec<Attribute> = vec![("type", &kind)];
        attributes.extend(place.iter().map(|(key, value)| (*key, value as &dyn Display)));
        attributes.extend([("rgba", &colour as _), ("mass", &0 as _), ("contype", &0 as _)]);
        attributes.extend([("conaffinity", &0 as _), ("group", &1 as _)]);
        xml.empty("geom", &attributes);
    }
}

/// Returns the type of a geom, and the attributes of its place and size.
fn form(form: &Form) -> (&'static str, Vec<(&'static str, String)>) {
    let ends = |from: [f64; 3], to: [f64; 3]| ("fromto", metres(from.into_iter().chain(to)));
    match *form {
        Form::Capsule { from, to, radius } => ("capsule", vec![ends(from, to), ("size", metres([radius]))]),
        Form::Cylinder { from, to, radius } => ("cylinder", vec![ends(from, to), ("size", metres([radius]))]),
        Form::Sphere { centre, radius } => ("sphere", vec![("pos", metres(centre)), ("size", metres([radius]))]),
        Form::Box { centre, size } => {
            ("box", vec![("pos", metres(centre)), ("size", metres(size.map(|edge| edge / 2.0)))])
        }
    }
}

fn object(xml: &mut Xml, object: &Object) {
    xml.open("body", &[("name", &"object"), ("pos", &metres(object.position))]);
    xml.empty("freejoint", &[("name", &"object")]);
    xml.empty("inertial", &[("pos", &"0 0 0"), ("mass", &object.mass), ("diaginertia", &numbers(object.inertia))]);
    let (kind, place) = form(&object.shape.form);
    // Because the object has a priority, MuJoCo uses the friction of the object in each contact of the object.
    let friction = numbers([object.friction, 0.005, 0.0001]);
    let colour = numbers(object.shape.colour.unit().into_iter().chain([1.0]));
    let mut attributes: Vec<Attribute> = vec![("name", &"object"), ("type", &kind)];
    attributes.extend(place.iter().map(|(key, value)| (*key, value as &dyn Display)));
    attributes.extend([("rgba", &colour as _), ("friction", &friction as _), ("priority", &1 as _)]);
    attributes.extend([("contype", &0 as _), ("conaffinity", &1 as _)]);
    xml.empty("geom", &attributes);
    xml.close();
    if let Some(table) = object.table {
        let plane: [Attribute; 7] = [
            ("name", &"table"),
            ("type", &"plane"),
            ("pos", &metres(table.point)),
            ("zaxis", &numbers(table.up)),
            ("size", &"0.2 0.2 0.01"),
            ("rgba", &"0.72 0.75 0.78 0.4"),
            ("conaffinity", &0),
        ];
        xml.empty("geom", &plane);
    }
}

/// Writes the tendons, and an actuator for each tendon. The attributes of a tendon contain the inertia, the viscous
/// friction and the dry friction of its rotor.
fn tendons(xml: &mut Xml, geometry: &Geometry, configuration: &Configuration) {
    let each = || geometry.fingers.iter().flat_map(|finger| (0..4).map(move |tendon| (finger, tendon)));
    xml.open("tendon", &[]);
    for (finger, tendon) in each() {
        let configured = finger.configured(configuration);
        let simulation = &configured.simulation;
        let radius = configured.geometry.motor_radius[tendon] / 100.0;
        let attributes: [Attribute; 4] = [
            ("name", &format!("{}_tendon{}", finger.name, tendon + 1)),
            ("armature", &(simulation.rotor_inertia[tendon] / (radius * radius))),
            ("damping", &(simulation.motor_viscous_friction[tendon] / (radius * radius))),
            ("frictionloss", &(simulation.motor_coulomb_friction[tendon] / radius)),
        ];
        xml.open("fixed", &attributes);
        for (joint, arms) in finger.r.iter().enumerate().filter(|(_, arms)| arms[tendon] != 0.0) {
            let name = format!("{}_joint{joint}", finger.name);
            xml.empty("joint", &[("joint", &name), ("coef", &metres([arms[tendon]]))]);
        }
        xml.close();
    }
    xml.close();
    xml.open("actuator", &[]);
    for (finger, tendon) in each() {
        let name = format!("{}_tendon{}", finger.name, tendon + 1);
        let range = numbers([0.0, finger.configured(configuration).tendon.maximum]);
        xml.empty("motor", &[("name", &name), ("tendon", &name), ("ctrlrange", &range)]);
    }
    xml.close();
}

/// Writes the keyframe `start`: the pose at the start and, as controls, the pretension of every finger, whose smallest
/// tension is `tendon.minimum`.
fn start(xml: &mut Xml, geometry: &Geometry, configuration: &Configuration) -> Result<(), TendonsError> {
    let mut pose: Vec<f64> = geometry.fingers.iter().flat_map(|finger| finger.start).collect();
    if let Some(object) = &geometry.object {
        pose.extend(object.position.map(|cm| cm / 100.0));
        pose.extend([1.0, 0.0, 0.0, 0.0]);
    }
    let mut pull = Vec::new();
    for finger in geometry.fingers.iter().map(|finger| finger.configured(configuration)) {
        pull.extend(finger.true_tendons()?.pretension(finger.tendon.minimum).iter());
    }
    xml.open("keyframe", &[]);
    xml.empty("key", &[("name", &"start"), ("qpos", &numbers(pose)), ("ctrl", &numbers(pull))]);
    xml.close();
    Ok(())
}
