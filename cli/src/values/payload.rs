//! Reads a payload from the command line.

use rne::Payload;

use crate::outcome::Failure;
use crate::values::numbers::List;

/// The numbers of a payload in words, for messages.
pub(super) const PAYLOAD: &str =
    "mass, centre of mass and inertia about it: m,cx,cy,cz,xx,yy,zz,xy,xz,yz; or m,cx,cy,cz of a point";

/// Makes a payload from a list: mass and centre of mass, and the inertia if the list has it.
pub(crate) fn payload(List(values): &List) -> Result<Payload<f64>, Failure> {
    if values.len() != 4 && values.len() != 10 {
        let found = values.len();
        return Err(usage_error!("--payload needs 10 or 4 numbers, not {found}: {PAYLOAD}"));
    }
    let mut all = [0.0; 10];
    all.iter_mut().zip(values).for_each(|(number, value)| *number = *value);
    let payload = Payload::from_array(all);
    payload.check().map_err(|error| usage_error!("--payload: {error}"))?;
    payload.inertia.check_of_payload().map_err(|error| usage_error!("--payload: {error}"))?;
    Ok(payload)
}
