//! Between byte offsets and the protocol. Nothing else in the program mentions UTF-16.

pub(crate) mod changes;
mod joined;
pub(crate) mod outgoing;
mod places;
pub(crate) mod position;
pub(crate) mod tokens;
pub(crate) mod written;

pub(crate) use self::joined::joined;
pub(crate) use self::places::{Opened, Places, Uris};
pub(crate) use self::position::{Encoding, Positions, TextIndex};
