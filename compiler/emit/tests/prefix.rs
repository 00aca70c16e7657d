//! Names of C: what may stand before those of a file.

use rne_emit::{BadPrefix, Prefix};

#[test]
fn a_prefix_begins_an_identifier() {
    for good in ["a", "puma560", "MyArm", "my_arm_2"] {
        assert_eq!(good.parse::<Prefix>().map(|prefix| prefix.to_string()), Ok(good.to_owned()));
    }
    for bad in ["", "_arm", "my__arm", "arm_", "2arm", "my-arm", "my arm", "bras_é", "a;", "a\n"] {
        assert_eq!(bad.parse::<Prefix>(), Err(BadPrefix), "{bad:?}");
    }
}
