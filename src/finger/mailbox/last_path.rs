//! What later changes of a set point need to know about the path that was sent last.

use crate::control::SetPoint;
use crate::control::motion::PathExtent;
use nalgebra::Matrix6;

/// The path that was sent last, as far as later changes of the set point depend on it.
#[derive(Default)]
pub(super) struct LastPath {
    /// Number of the path; 0 if there was none.
    pub number: u32,
    /// Number of the set point to which the path leads.
    pub set_point: u32,
    /// The stiffness with which the path begins; none if it is the stiffness in force.
    pub begin: Option<Matrix6<f64>>,
    pub extent: PathExtent,
}

/// Changes a set point. If `path` changes the stiffness, the set point has the stiffness of the path's stiffest spring
/// while `change` runs, and `change` must not change the stiffness. So a check of the damping in `change` holds for the
/// whole path, because the range of the damping narrows as the stiffness grows.
pub(super) fn change_along<E>(
    path: Option<PathExtent>,
    set_point: &mut SetPoint,
    change: impl FnOnce(&mut SetPoint) -> Result<(), E>,
) -> Result<(), E> {
    let Some(PathExtent { stiffest: Some(stiffest), .. }) = path else { return change(set_point) };
    let end = std::mem::replace(&mut set_point.stiffness, stiffest);
    let changed = change(set_point);
    set_point.stiffness = end;
    changed
}
