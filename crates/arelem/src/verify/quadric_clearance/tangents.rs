//! Where a tool is nearest to a convex body, and the contact that was found is not shown to be it.
//!
//! A circle of the tool is no convex set: it may be nearest at two places that are as close to each other as one likes, with a ridge between
//! them that no step in azimuth is short enough for. Distance from the body is a convex function of the place, so that it is
//! nowhere below its tangents: those at two azimuths bound it between them, and what they leave open is halved.

use apt_geometry::Vec3;

use super::{AZIMUTHS, OnLine, Search};
use crate::verify::tool::Meridian;

/// Sectors of a piece of the tool that are halved; what is open then is the error term.
const SECTORS: usize = 1000;
/// What tangents leave of the distance, relative to the tool, that is rounding.
const SETTLED: f64 = 1e-12;

/// The nearest place of a straight piece of the tool at one azimuth.
#[derive(Debug, Clone, Copy)]
struct Ray {
    azimuth: f64,
    nearest: OnLine,
    place: Vec3,
}

/// What is between two azimuths, and what tangents leave there.
#[derive(Debug, Clone, Copy)]
struct Sector {
    rays: [Ray; 2],
    least: f64,
}

impl Search<'_> {
    /// Looks for a nearer place than the best one on the straight pieces of the tool, edges included: by how much nearer one could
    /// be for all that tangents tell.
    pub(super) fn nearest_by_tangents(&mut self) -> Option<f64> {
        let mut lowest = f64::INFINITY;
        for (a, b) in self.tool.profile.lines() {
            lowest = lowest.min(self.lowest_by_tangents([a, b])?);
        }
        Some((self.best_value() - lowest).max(0.0))
    }

    /// No place of a straight piece of the tool, all about the axis, is nearer than this, or than the best candidate.
    fn lowest_by_tangents(&mut self, ends: [Meridian; 2]) -> Option<f64> {
        let slack = SETTLED * self.tool.profile.reach();
        let step = std::f64::consts::TAU / AZIMUTHS as f64;
        let first = self.ray(ends, 0.0)?;
        let mut rays = vec![first];
        for k in 1..AZIMUTHS {
            rays.push(self.ray(ends, step * k as f64)?);
        }
        rays.push(Ray { azimuth: std::f64::consts::TAU, ..first });
        let mut open: Vec<Sector> =
            rays.windows(2).map(|pair| self.sector(ends, [pair[0], pair[1]])).collect();
        let nearest =
            |open: &[Sector]| (0..open.len()).min_by(|a, b| open[*a].least.total_cmp(&open[*b].least));
        for _ in 0..SECTORS {
            let Some(worst) = nearest(&open) else { break };
            if self.best_value() - open[worst].least <= slack {
                break;
            }
            let [from, to] = open.swap_remove(worst).rays;
            let middle = self.ray(ends, 0.5 * (from.azimuth + to.azimuth))?;
            open.extend([self.sector(ends, [from, middle]), self.sector(ends, [middle, to])]);
        }
        Some(open.iter().map(|sector| sector.least).fold(f64::INFINITY, f64::min))
    }

    fn sector(&self, ends: [Meridian; 2], rays: [Ray; 2]) -> Sector {
        Sector { least: self.tangents_between(ends, [&rays[0], &rays[1]]), rays }
    }

    /// The nearest place at an azimuth, which is a candidate.
    fn ray(&mut self, [a, b]: [Meridian; 2], azimuth: f64) -> Option<Ray> {
        let nearest = self.on_line(a, b, azimuth)?;
        self.offer_on_line(a, b, azimuth, nearest.t)?;
        let (start, end) = (self.place(a, azimuth), self.place(b, azimuth));
        Some(Ray { azimuth, nearest, place: start.lerp(&end, nearest.t) })
    }

    /// What the tangents at two azimuths leave between them: arcs there are in the triangle of their ends and of where their tangents
    /// meet, and a linear function is least at a corner.
    fn tangents_between(&self, ends: [Meridian; 2], [from, to]: [&Ray; 2]) -> f64 {
        let half = 0.5 * (to.azimuth - from.azimuth);
        let corners = ends.map(|[rho, height]| {
            [
                self.place([rho, height], from.azimuth),
                self.place([rho / half.cos(), height], from.azimuth + half),
                self.place([rho, height], to.azimuth),
            ]
        });
        let least = |ray: &Ray| {
            let at = |corner: &Vec3| ray.nearest.value + ray.nearest.normal.dot(&(corner - ray.place));
            corners.iter().flatten().map(at).fold(f64::INFINITY, f64::min)
        };
        least(from).max(least(to))
    }
}
