//! Restart mode: after a failure, motion commands are ignored until position and direction are well defined again
//! (arelem reference 3.1), so that one mistake does not bring others with it. APT4 has none: the tool stays where it is, and
//! the next command is carried out from there (language reference 10.4).

use apt_geometry::motion::{Delta, MotionCommand};

use super::{StartUpRule, State};

/// Whether commands are carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Restart {
    /// Normal mode.
    #[default]
    Running,
    /// Failed: waiting for a FROM, a GOTO or a POCKET.
    Waiting,
    /// A GOTO came: the next GOTO, GODLTA across the axis, INDIR or GO starts again.
    Positioned,
}

impl State {
    /// Enters restart mode, where the dialect has it, if the failed command is one that moves the tool or guides it.
    pub(super) fn fail(&mut self, command: &MotionCommand) {
        self.clear_one_shot();
        if is_motion(command) && self.start_up == StartUpRule::Apt3 {
            self.restart = Restart::Waiting;
        }
        if let MotionCommand::Cutter(_) = command {
            // No cutter is in force after a bad one: the next motion says so.
            self.cutter = None;
        }
        if let MotionCommand::Start(surfaces) = command
            && let Some(part) = surfaces.get(1)
        {
            self.part = part.surface.clone();
        }
    }

    /// Decides about a command in restart mode: true if it must be skipped.
    pub(super) fn skip(&mut self, command: &MotionCommand) -> bool {
        if self.restart == Restart::Running {
            return false;
        }
        match command {
            MotionCommand::From { .. } | MotionCommand::Pocket(_) => {
                self.restart = Restart::Running;
                false
            }
            MotionCommand::GoTo { .. } => {
                self.restart = match self.restart {
                    Restart::Waiting => Restart::Positioned,
                    Restart::Positioned | Restart::Running => Restart::Running,
                };
                false
            }
            MotionCommand::GoDelta { delta, .. } => {
                let across = match delta {
                    Delta::AlongAxis(_) => false,
                    Delta::Vector(v, _) => {
                        v.cross(&self.axis).norm() > super::state::ALONG_AXIS_SINE * v.norm()
                    }
                };
                if self.restart == Restart::Positioned && across {
                    self.restart = Restart::Running;
                }
                self.restart == Restart::Waiting
            }
            MotionCommand::Direction(directions) => {
                if self.restart == Restart::Positioned && directions[0].is_some() {
                    self.restart = Restart::Running;
                }
                self.restart == Restart::Waiting
            }
            MotionCommand::Start(_) | MotionCommand::Offset(_) => {
                if self.restart == Restart::Positioned {
                    self.restart = Restart::Running;
                }
                self.restart == Restart::Waiting
            }
            MotionCommand::Drive { .. } => {
                self.restart = Restart::Waiting;
                true
            }
            _ => false,
        }
    }
}

/// Commands whose failure leaves the tool's position or direction undefined.
fn is_motion(command: &MotionCommand) -> bool {
    matches!(
        command,
        MotionCommand::From { .. }
            | MotionCommand::GoTo { .. }
            | MotionCommand::GoDelta { .. }
            | MotionCommand::Direction(_)
            | MotionCommand::SurfaceVectors(_)
            | MotionCommand::Start(_)
            | MotionCommand::Offset(_)
            | MotionCommand::Drive { .. }
            | MotionCommand::Pocket(_)
    )
}
