//! The node: topics, and the loop between them.

use std::net::IpAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use futures::executor::block_on;
use ros2_client::qos::{History, WhenFull};
use ros2_client::{
    Context, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher, QosProfile, Subscription, WriteError,
};
use rustdds::DomainParticipantBuilder;
use rustdds::mio1::{Events, Interest, Poll, Token};
use serde::Serialize;

use crate::diagnosis::Source;
use crate::messages::{DiagnosticArray, JointState, Time};
use crate::monitor::Monitor;
use crate::sequence::Sequences;

/// The time between two diagnostics.
const DIAGNOSTICS: Duration = Duration::from_secs(1);

/// The longest wait for a message, after which the node checks whether it has to end.
const WAIT: Duration = Duration::from_millis(100);

/// The topic of diagnostics, which has this name in every ROS system.
const DIAGNOSTICS_TOPIC: &str = "/diagnostics";

/// Topics and network of the node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The DDS domain, 0 to 232.
    pub domain: u16,
    /// Addresses of the network interfaces that are used; without any, all of them.
    pub interfaces: Vec<IpAddr>,
    /// The name of the node, and the namespace of its topics, such as `rne`.
    pub name: String,
    /// The topic of the joint states.
    pub topic: String,
    /// How many messages publishers and the subscription keep.
    pub depth: usize,
    /// Whether the joint states of publishers that are not reliable are read, too.
    pub best_effort: bool,
}

/// The topics of the node.
struct Topics {
    joint_states: Subscription<JointState>,
    gravity: Publisher<JointState>,
    external: Publisher<JointState>,
    diagnostics: Publisher<DiagnosticArray>,
}

/// Runs the node until `is_ended`; `started` is called with the topics when all of them have been created.
///
/// # Errors
/// When a name is not a valid name of a ROS topic or node. When the participant, its topics or its sockets cannot be
/// created.
pub fn run(
    mut monitor: Monitor,
    options: &Options,
    is_ended: &AtomicBool,
    started: impl FnOnce([&str; 4]),
) -> Result<(), String> {
    let mut node = node(options)?;
    let own = |topic: &str| format!("/{}/{topic}", options.name);
    let outputs = [own("gravity_torques"), own("external_torques")];
    let mut topics = topics(&mut node, options, &outputs)?;
    let spinner = node.spinner().map_err(|error| format!("the node cannot listen to others: {error}"))?;
    let spinning = thread::spawn(move || block_on(spinner.spin()));
    let mut poll = Poll::new().map_err(|error| error.to_string())?;
    poll.registry()
        .register(&mut topics.joint_states, Token(0), Interest::READABLE)
        .map_err(|error| format!("{} cannot be read: {error}", options.topic))?;
    started([&options.topic, &outputs[0], &outputs[1], DIAGNOSTICS_TOPIC]);
    let (mut events, mut sequences) = (Events::with_capacity(8), Sequences::default());
    let mut next = Instant::now() + DIAGNOSTICS;
    while !is_ended.load(Ordering::Relaxed) {
        let wait = next.saturating_duration_since(Instant::now()).min(WAIT);
        // a signal ends the wait, and no other error is known
        let _ = poll.poll(&mut events, Some(wait));
        read(&mut monitor, &topics, &mut sequences, next);
        if Instant::now() >= next {
            next = Instant::now() + DIAGNOSTICS;
            let publishers = topics.joint_states.get_publisher_count(&node);
            let source = Source { node: &options.name, topic: &options.topic, publishers };
            let diagnostics = monitor.diagnostics(now(), &source);
            publish(&topics.diagnostics, diagnostics, &mut monitor);
        }
    }
    drop(topics);
    drop(node);
    // this thread ends with the node
    let _ = spinning.join();
    Ok(())
}

/// Reads the messages that have arrived and publishes their torques. It returns at the latest when diagnostics are due,
/// so that a flood of messages does not delay them.
fn read(monitor: &mut Monitor, topics: &Topics, sequences: &mut Sequences, until: Instant) {
    loop {
        match topics.joint_states.take() {
            Ok(Some((message, info))) => {
                let lost = sequences.lost(info.publisher_gid().to_bytes16(), info.sequence_number());
                if lost > 0 {
                    monitor.lost(lost);
                }
                if let Ok(torques) = monitor.update(&message, now()) {
                    publish(&topics.gravity, torques.gravity, monitor);
                    if let Ok(external) = torques.external {
                        publish(&topics.external, external, monitor);
                    }
                }
            }
            Ok(None) => return,
            Err(error) => monitor.failed("not decoded", format!("a message is no joint state: {error}")),
        }
        if Instant::now() >= until {
            return;
        }
    }
}

/// Publishes a message without waiting, so that a subscriber that does not read cannot block the others.
fn publish<M: Serialize>(publisher: &Publisher<M>, message: M, monitor: &mut Monitor) {
    match publisher.publish(message) {
        Ok(()) => {}
        Err(WriteError::WouldBlock { .. }) => {
            let why = "torques were not published, because a reliable subscriber does not acknowledge them";
            monitor.failed("not published", why.to_owned());
        }
        Err(error) => monitor.failed("not published", format!("torques were not published: {error}")),
    }
}

fn node(options: &Options) -> Result<Node, String> {
    let name = NodeName::new("/", &options.name).map_err(|_| {
        format!("--name {} is not a node name: use letters, digits and _, but no digit first", options.name)
    })?;
    if options.domain > 232 {
        return Err(format!("--domain is {}; it must be 0 to 232", options.domain));
    }
    let mut builder = DomainParticipantBuilder::new(options.domain);
    if !options.interfaces.is_empty() {
        builder = builder.with_only_networks(options.interfaces.clone());
    }
    let participant = builder.build().map_err(|error| format!("there is no DDS participant: {error}"))?;
    let context = Context::from_domain_participant(participant).map_err(|error| error.to_string())?;
    context
        .new_node(name, NodeOptions::new().enable_rosout(false))
        .map_err(|error| format!("there is no node: {error:?}"))
}

fn topics(node: &mut Node, options: &Options, [gravity, external]: &[String; 2]) -> Result<Topics, String> {
    let history = History::KeepLast { depth: options.depth };
    let reliable = QosProfile::publisher_default().reliability_reliable(WhenFull::Fail).history(history);
    let own = if options.best_effort { reliable.clone().reliability_best_effort() } else { reliable.clone() };
    let topic = |node: &Node, name: &str, package: &str, kind: &str, qos: &QosProfile| {
        let parsed = Name::parse(name).map_err(|_| {
            format!(
                "{name} is not a topic name: use names of letters, digits and _, each after a /, as /arm/joint_states"
            )
        })?;
        let created = node.create_topic(&parsed, MessageTypeName::new(package, kind), qos);
        created.map_err(|error| format!("there is no topic {name}: {error}"))
    };
    let of_states = topic(node, &options.topic, "sensor_msgs", "JointState", &own)?;
    let of_gravity = topic(node, gravity, "sensor_msgs", "JointState", &reliable)?;
    let of_external = topic(node, external, "sensor_msgs", "JointState", &reliable)?;
    let of_diagnostics = topic(node, DIAGNOSTICS_TOPIC, "diagnostic_msgs", "DiagnosticArray", &reliable)?;
    let failed = |error: ros2_client::CreateError| format!("a topic cannot be opened: {error}");
    Ok(Topics {
        joint_states: node.create_subscription(&of_states, Some(own)).map_err(failed)?,
        gravity: node.create_publisher(&of_gravity, Some(reliable.clone())).map_err(failed)?,
        external: node.create_publisher(&of_external, Some(reliable.clone())).map_err(failed)?,
        diagnostics: node.create_publisher(&of_diagnostics, Some(reliable)).map_err(failed)?,
    })
}

/// Returns the time of the system clock.
fn now() -> Time {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    Time::of_nanoseconds(i64::try_from(since.as_nanos()).unwrap_or(i64::MAX))
}
