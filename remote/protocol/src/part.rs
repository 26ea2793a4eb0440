//! The set point of one finger in a Target.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason, finite, within};
use crate::{Finger, PathPose, path};

/// The set point of one finger.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The finger.
    pub finger: Finger,
    /// The command number, not 0. The server applies the part if this number differs from the last one that it applied
    /// to the finger in this epoch.
    pub command: u32,
    /// Where the finger is to be.
    pub place: Place,
    /// Kx in the finger's frame, N/cm: `rows[row][column]`. None keeps it.
    pub stiffness: Option<[[f64; 3]; 3]>,
    /// Relative damping. None keeps it.
    pub damping: Option<f64>,
}

/// Where a finger is to be.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Place {
    /// At the set point that it already has.
    #[default]
    Kept,
    /// At these joint angles, rad.
    Joints([f64; 3]),
    /// With its tip at this position in the finger's frame, cm.
    Tip([f64; 3]),
    /// On this path.
    Path(Vec<PathPose>),
}

const STIFFNESS_GIVEN: u8 = 1;
const DAMPING_GIVEN: u8 = 2;

impl Part {
    /// Bytes of a part without the poses of a path.
    pub(crate) const FIXED: usize = 112;

    /// The length of the part that begins with these bytes. The caller has checked that [`Part::FIXED`] bytes are
    /// there.
    pub(crate) fn length_at(bytes: Bytes<'_>) -> usize {
        Self::FIXED + usize::from(bytes.u8(3)) * PathPose::LENGTH
    }

    pub(crate) fn length(&self) -> usize {
        Self::FIXED + self.poses().len() * PathPose::LENGTH
    }

    fn poses(&self) -> &[PathPose] {
        match &self.place {
            Place::Path(poses) => poses,
            Place::Kept | Place::Joints(_) | Place::Tip(_) => &[],
        }
    }

    pub(crate) fn decode(bytes: Bytes<'_>) -> Result<Self, FieldError> {
        let (kind, bits, count, numbers) = (bytes.u8(1), bytes.u8(2), bytes.u8(3), bytes.f64s::<3>(8));
        within("place", u64::from(kind), 0, 3)?;
        if bits & !(STIFFNESS_GIVEN | DAMPING_GIVEN) != 0 {
            return Err(FieldError::new("bits", Reason::Bits(bits)));
        }
        if count != 0 && kind != 3 {
            return Err(FieldError::new("number of poses", Reason::Contradicts("the place, which is not a path")));
        }
        let place = match kind {
            1 => Place::Joints(numbers),
            2 => Place::Tip(numbers),
            3 => Place::Path((0..usize::from(count)).map(|pose| pose_at(bytes, pose)).collect()),
            _ => Place::Kept,
        };
        if matches!(place, Place::Kept | Place::Path(_)) {
            zero("joint angles or tip", &numbers)?;
        }
        let (kx, damping) = (bytes.f64s::<9>(32), bytes.f64(104));
        let stiffness = given(bits & STIFFNESS_GIVEN != 0, "Kx", &kx)?;
        let damping = given(bits & DAMPING_GIVEN != 0, "damping", &[damping])?.then_some(damping);
        let stiffness =
            stiffness.then(|| std::array::from_fn(|row| std::array::from_fn(|column| kx[3 * row + column])));
        let part = Self { finger: Finger::decode(bytes.u8(0))?, command: bytes.u32(4), place, stiffness, damping };
        part.check()?;
        Ok(part)
    }

    pub(crate) fn check(&self) -> Result<(), FieldError> {
        within("command number", u64::from(self.command), 1, u64::from(u32::MAX))?;
        match &self.place {
            Place::Kept => {}
            Place::Joints(joints) => finite("joint angles", joints)?,
            Place::Tip(tip) => finite("tip", tip)?,
            Place::Path(poses) => path::check(poses)?,
        }
        finite("Kx", self.stiffness.iter().flatten().flatten().copied().collect::<Vec<_>>().as_slice())?;
        finite("damping", self.damping.as_slice())
    }

    pub(crate) fn encode(&self, to: &mut Written) {
        let (kind, numbers) = match self.place {
            Place::Kept => (0, [0.0; 3]),
            Place::Joints(joints) => (1, joints),
            Place::Tip(tip) => (2, tip),
            Place::Path(_) => (3, [0.0; 3]),
        };
        let bits = if self.stiffness.is_some() { STIFFNESS_GIVEN } else { 0 }
            | if self.damping.is_some() { DAMPING_GIVEN } else { 0 };
        to.bytes(&[self.finger.number(), kind, bits, self.poses().len() as u8]);
        to.u32(self.command).f64s(&numbers);
        self.stiffness.unwrap_or_default().iter().for_each(|row| {
            to.f64s(row);
        });
        to.f64s(&[self.damping.unwrap_or_default()]);
        for pose in self.poses() {
            to.f64s(&[pose.time]).f64s(&pose.joints);
        }
    }
}

fn pose_at(bytes: Bytes<'_>, pose: usize) -> PathPose {
    let at = Part::FIXED + pose * PathPose::LENGTH;
    PathPose { time: bytes.f64(at), joints: bytes.f64s(at + 8) }
}

/// Returns `given`. If it is false, refuses numbers that are not zero.
fn given(given: bool, field: &'static str, numbers: &[f64]) -> Result<bool, FieldError> {
    if !given {
        zero(field, numbers)?;
    }
    Ok(given)
}

fn zero(field: &'static str, numbers: &[f64]) -> Result<(), FieldError> {
    match numbers.iter().all(|&number| number == 0.0) {
        true => Ok(()),
        false => Err(FieldError::new(field, Reason::NotZero)),
    }
}
