//! The vertex of a cone: the planes that touch the cone there alone.
//!
//! Their normals n fill the cap `n·T ≤ −sin α` round the direction away from the solid, with the tangent planes of the
//! surface as its rim. Any of them bounds the clearance; the best one within the cap is found where it is stationary, which
//! happens only in the half-plane of the tool axis and the vertex, so that a few directions are all there is to try.

use apt_geometry::Vec3;

use super::{
    pencil::{Found, Pencil},
    tool::Tool,
};

/// Rounding of a clearance, relative to the distances that go into it.
const ROUNDING: f64 = 1e-14;

impl Pencil {
    fn is_in_fan(&self, n: &Vec3) -> bool {
        n.dot(&self.axis) <= -self.sine
    }

    /// Raises the clearance of a tool outside, with its end at `w` from the vertex, from that of the best tangent plane to
    /// that of the best plane through the vertex. Deep in the cone too: every plane is a lower bound.
    pub(super) fn raise_by_vertex(&self, w: &Vec3, tool: &Tool<'_>, best: &mut Found) {
        if self.sine <= 0.0 {
            return;
        }
        // No plane leaves more than the distance of any one place of the tool.
        let contact = w + tool.support(&-best.normal).1;
        let along = contact.dot(&self.axis);
        let rho = (contact - self.axis * along).norm();
        let behind = along * self.cosine + rho * self.sine < 0.0;
        let slack = ROUNDING * (w.norm() + contact.norm());
        if !behind && rho * self.cosine - along * self.sine <= best.value + slack {
            return;
        }
        for outward in tool.outward_at(&-w) {
            let n = -outward;
            if self.is_in_fan(&n) {
                let value = n.dot(w) - tool.support(&outward).0;
                if value > best.value {
                    *best = Found { value, normal: n, ..*best };
                }
            }
        }
    }

    /// The same for a tool inside: raises how far the tool reaches beyond the best tangent plane to how far it sticks out
    /// through the vertex.
    pub(super) fn raise_by_poking(&self, w: &Vec3, tool: &Tool<'_>, best: &mut Found) {
        let back = -self.axis;
        if self.sine <= 0.0 || back.dot(w) + tool.support(&back).0 <= 0.0 {
            return;
        }
        for n in tool.away_from(&-w) {
            if self.is_in_fan(&n) {
                let value = n.dot(w) + tool.support(&n).0;
                if value > best.value {
                    *best = Found { value, normal: n, ..*best };
                }
            }
        }
    }
}
