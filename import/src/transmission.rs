//! Reads elements `transmission` of a URDF: gears and rotors of joints.
//!
//! It reads `mechanicalReduction` of ros_control, as a text, and `rotor_inertia` and `gear_ratio` of Drake, as
//! attributes `value`, with or without the prefix `drake:`. Everything else in a transmission is ignored.

use std::borrow::Cow;
use std::ops::Range;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use rne_model::Report;

use crate::source::{Source, quoted};
use crate::urdf::xml::LARGEST;

/// A transmission between motors and joints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Transmission {
    pub(crate) name: String,
    /// The names of the joints of the transmission.
    pub(crate) joints: Vec<String>,
    /// The number of its actuators.
    pub(crate) actuators: usize,
    /// Gear ratio: motor angle per joint angle.
    pub(crate) ratio: Option<f64>,
    /// Inertia of the rotor, kg m², or its mass, kg.
    pub(crate) rotor_inertia: Option<f64>,
}

/// Reads the transmissions of a text that is known to be a URDF.
pub(crate) fn read(source: &Source) -> Result<Vec<Transmission>, Report> {
    let mut found: Vec<Transmission> = Vec::new();
    if !source.text.contains("<transmission") {
        return Ok(found);
    }
    let mut reader = Reader::from_str(&source.text);
    // the names of the elements around the current place
    let mut open: Vec<String> = Vec::new();
    loop {
        let start = usize::try_from(reader.buffer_position()).unwrap_or(0);
        let event = reader.read_event();
        let end = usize::try_from(reader.buffer_position()).unwrap_or(0).max(start);
        match event {
            Ok(Event::Start(tag)) => {
                let name = local_name(&tag);
                element(source, &mut found, &open, (&name, &tag), start..end)?;
                open.push(name);
            }
            Ok(Event::Empty(tag)) => element(source, &mut found, &open, (&local_name(&tag), &tag), start..end)?,
            Ok(Event::End(_)) => {
                open.pop();
            }
            Ok(Event::Text(text)) if open.last().is_some_and(|name| name == "mechanicalReduction") => {
                let text = String::from_utf8_lossy(text.as_ref()).into_owned();
                if let (true, Some(transmission)) = (is_within(&open), found.last_mut()) {
                    let ratio = ratio(source, "mechanicalReduction", &text, start..end)?;
                    transmission.ratio = Some(transmission.ratio.unwrap_or(1.0) * ratio);
                }
            }
            Ok(Event::Eof) | Err(_) => return Ok(found),
            Ok(_) => {}
        }
    }
}

/// Returns the name of an element without the prefix of a namespace.
fn local_name(tag: &BytesStart) -> String {
    String::from_utf8_lossy(tag.local_name().as_ref()).into_owned()
}

/// Returns whether the current place is inside an element `transmission` of the robot.
fn is_within(open: &[String]) -> bool {
    open.get(..2).is_some_and(|outer| outer == ["robot", "transmission"])
}

fn element(
    source: &Source,
    found: &mut Vec<Transmission>,
    open: &[String],
    (name, tag): (&str, &BytesStart),
    span: Range<usize>,
) -> Result<(), Report> {
    let attribute = |key: &str| {
        let attribute =
            tag.attributes().with_checks(false).flatten().find(|known| known.key.as_ref() == key.as_bytes())?;
        let value = String::from_utf8_lossy(&attribute.value).into_owned();
        Some(quick_xml::escape::unescape(&value).map_or_else(|_| value.clone(), Cow::into_owned))
    };
    if (name, open) == ("transmission", &["robot".to_owned()][..]) {
        let name = attribute("name").unwrap_or_default();
        found.push(Transmission { name, ..Transmission::default() });
        return Ok(());
    }
    let Some(transmission) = found.last_mut().filter(|_| is_within(open)) else { return Ok(()) };
    match name {
        "joint" if open.len() == 2 => transmission.joints.extend(attribute("name")),
        "actuator" if open.len() == 2 => transmission.actuators += 1,
        "gear_ratio" => {
            if let Some(value) = attribute("value") {
                transmission.ratio = Some(ratio(source, name, &value, span)?);
            }
        }
        "rotor_inertia" => {
            if let Some(value) = attribute("value") {
                let inertia = value.trim().parse().ok().filter(|inertia| (0.0..=LARGEST).contains(inertia));
                transmission.rotor_inertia = Some(inertia.ok_or_else(|| {
                    let message = format!("`rotor_inertia` is {}; it must be a number from 0 to 1e9", quoted(&value));
                    source.error(&span, message, None)
                })?);
            }
        }
        _ => {}
    }
    Ok(())
}

/// Reads a gear ratio, which must not be zero.
fn ratio(source: &Source, what: &str, text: &str, span: Range<usize>) -> Result<f64, Report> {
    let ratio = text.trim().parse().ok().filter(|ratio: &f64| (1e-6..=1e6).contains(&ratio.abs()));
    ratio.ok_or_else(|| {
        let message = format!("`{what}` of a transmission is {}; a ratio is a number from 1e-6 to 1e6", quoted(text));
        source.error(&span, message, "it is motor angle by joint angle, such as 50")
    })
}
