//! Conversations with the server over a pipe in memory, with a toy language that can be slow and fail.

mod conversation;
mod features;
mod order;
mod survival;
