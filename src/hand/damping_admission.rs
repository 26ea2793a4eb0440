//! Whether the damping of a set point and its stiffness go together.

use crate::control::{AdmissibleDamping, SetPoint};
use crate::hand::SetPointError;
use crate::model::Contact;
use crate::model::configuration::OutOfRange;
use nalgebra::Matrix6;

/// The check of one finger. A copy of it goes along with each change of a set point, because it must see damping and
/// stiffness in the step that sends them: two planners may change one each at the same time.
#[derive(Clone, Copy, Debug)]
pub(super) struct DampingAdmission {
    /// 1 to 3.
    pub finger: i32,
    /// What the finger's controller admits.
    pub admissible: AdmissibleDamping,
    /// By which a rotational stiffness counts, cm: the length of the last link.
    pub lever: f64,
    /// Refuse or clamp.
    pub out_of_range: OutOfRange,
}

impl DampingAdmission {
    /// Refuses a set point whose damping is outside the range of its stiffness, or clamps its damping.
    pub fn admit(&self, set_point: &mut SetPoint) -> Result<(), SetPointError> {
        if set_point.damping == 1.0 {
            return Ok(()); // Admitted with every stiffness: the calls that planners make most need no eigenvalue.
        }
        let finger = self.finger;
        let contact = Contact::general(&set_point.stiffness, &Matrix6::identity());
        let contact = contact.map_err(|source| SetPointError::Contact { finger, source })?;
        let stiffness = contact.largest_eigenvalue(self.lever);
        let (least, most) = self.admissible.range(stiffness);
        let ratio = set_point.damping;
        if !(least..=most).contains(&ratio) && self.out_of_range == OutOfRange::Refuse {
            return Err(SetPointError::Damping { finger, ratio, stiffness, least, most });
        }
        set_point.damping = ratio.clamp(least, most);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;
    use nalgebra::{Matrix3, Vector3};

    fn set_point(stiffness: f64, damping: f64) -> SetPoint {
        SetPoint { damping, ..SetPoint::hard_finger(Vector3::zeros(), Matrix3::identity() * stiffness) }
    }

    fn admission(out_of_range: OutOfRange) -> DampingAdmission {
        let admissible = AdmissibleDamping::new(&ConfiguredFinger::default(), 1000.0);
        DampingAdmission { finger: 2, admissible, lever: 4.0, out_of_range }
    }

    #[test]
    fn what_would_swing_or_break_a_tendon_is_refused_with_the_range() {
        let refuse = admission(OutOfRange::Refuse);
        for (stiffness, damping) in
            [(3.0, 3.0), (6.0, 2.0), (6.0, 0.5), (3.0, 0.2), (6.0, 0.2), (3.0, 0.66), (6.0, 1.19)]
        {
            let refused = refuse.admit(&mut set_point(stiffness, damping)).expect_err("refused");
            let (least, most) = refuse.admissible.range(stiffness);
            let text = refused.to_string();
            assert!(text.contains(&format!("{least:.2} to {most:.2}")), "{text}");
        }
        for (stiffness, damping) in [(3.0, 0.67), (3.0, 1.84), (6.0, 0.94), (6.0, 1.18), (0.0, 0.4), (11.0, 1.0)] {
            let mut admitted = set_point(stiffness, damping);
            refuse.admit(&mut admitted).expect("admitted");
            assert_eq!(admitted, set_point(stiffness, damping));
        }
    }

    #[test]
    fn clamping_changes_the_damping_only() {
        for (stiffness, damping, clamped) in [(3.0, 0.0, 0.67), (6.0, 9.0, 1.18), (6.0, 1.0, 1.0)] {
            let mut admitted = set_point(stiffness, damping);
            admission(OutOfRange::Clamp).admit(&mut admitted).expect("clamped");
            assert_eq!(admitted, set_point(stiffness, clamped));
        }
    }

    #[test]
    fn a_torsion_counts_by_the_lever_of_the_last_link() {
        let mut torsion = set_point(0.0, 1.5);
        torsion.stiffness[(3, 3)] = 96.0; // 6 N/cm at 4 cm
        let refused = admission(OutOfRange::Refuse).admit(&mut torsion);
        assert!(
            matches!(refused, Err(SetPointError::Damping { stiffness, .. }) if (stiffness - 6.0).abs() < 1e-9),
            "{refused:?}"
        );
    }
}
