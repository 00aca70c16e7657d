//! The floating base: a link that no joint connects to the world, such as the trunk of a robot that walks. Its frame is
//! frame 0.

use crate::Link;

/// The link that carries the joints of a floating base: `floating_base` of a robot file.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatingBase {
    /// The name of the base, `[A-Za-z][A-Za-z0-9_]*`, which a file may write in place of `base`. No joint and no frame
    /// has it.
    pub name: String,
    /// Mass, centre of mass and inertia about the centre of mass, in frame 0.
    pub link: Link,
}
