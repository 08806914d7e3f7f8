//! Studies of a scene: measurements that are meant to be believed, and the pages that show them.
//!
//! Nothing here prints; the command line does, from what these functions return.

pub mod bench;
pub mod compare;
pub mod report;
