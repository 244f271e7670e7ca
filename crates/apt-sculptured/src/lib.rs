//! Regional milling on sculptured surfaces (SCON, SMIL), interference checking (CHKSRF), avoidance (AVCTRL) and gouge
//! checking (GOUGCK).
//!
//! One primitive carries the checks: the depth of a point in the tool is a concave function, so that the control points
//! of a patch bound the depth of all its points, and halving closes the gap to a proof. `docs/sculptured.md` says where
//! each routine of the CAM-I SSV3 interference checking module went.
//!
//! Lengths are in the part program's unit, angles in radians; normals point to the tool; depth is positive inside it.

pub mod check;
pub mod contact;
pub mod curvature;
pub mod error;
pub mod guide;
pub mod mill;
pub mod tool;

mod bounds;
