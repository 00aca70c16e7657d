//! Bags of ROS 2 in MCAP.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use mcap::McapError;
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use crate::LogError;
use crate::formats::bags::joint_state;
use crate::formats::bags::topic::{self, is_joint_state};
use crate::formats::guard::guarded;
use crate::formats::sample::{Sample, Source};
use crate::limits::LONGEST_NAME;

/// Number of bytes that are read from the file at once.
const PART: usize = 1 << 16;

/// Largest number of bytes of a record of any topic, and of a chunk. Images of some megabytes are below it.
const LONGEST_RECORD: usize = 32 << 20;

/// Largest ratio of the unpacked size of a chunk to its packed size; constant states have a ratio of about a hundred.
/// Chunks that unpack to at most `SMALL_CHUNK` bytes are accepted with any ratio.
const MOST_UNPACKED: u64 = 256;
const SMALL_CHUNK: u64 = 1 << 20;

/// Number of bytes before the content of a record: one for its kind, and eight for its length.
const HEAD: usize = 9;

/// Largest number of bytes of a message with joint states.
const LONGEST_MESSAGE: usize = 1 << 20;

/// A bag, read in the order of the file. The index at its end is not used and may be missing.
pub(crate) struct McapBag {
    path: PathBuf,
    file: File,
    size: u64,
    given: u64,
    /// Number of bytes of the records that were read; a chunk counts with all its content.
    read: u64,
    reader: LinearReader,
    /// The chunk whose records are being read.
    chunk: Option<Box<Chunk>>,
    wanted: Option<String>,
    /// The names of schemas by their numbers.
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    /// The topic that is read.
    topic: Option<String>,
    count: u64,
    ended: bool,
}

/// A chunk of the file, whose records a separate reader splits.
///
/// The reader of the library for whole files could split chunks too. But it does not check the lengths of records in
/// uncompressed chunks, so that its counter may underflow.
struct Chunk {
    reader: LinearReader,
    bytes: Vec<u8>,
    given: usize,
}

impl Chunk {
    /// Opens a chunk from the body of its record.
    fn of(body: &[u8]) -> Result<Self, McapError> {
        if let Record::Chunk { header, data } = mcap::parse_record(op::CHUNK, body)? {
            let unpacked = header.uncompressed_size;
            if unpacked > SMALL_CHUNK && unpacked / MOST_UNPACKED > data.len() as u64 {
                return Err(McapError::ChunkTooLarge(unpacked));
            }
            if header.compression.is_empty() {
                check_records(&data)?;
            }
        }
        let mut bytes = Vec::with_capacity(HEAD + body.len());
        bytes.push(op::CHUNK);
        bytes.extend((body.len() as u64).to_le_bytes());
        bytes.extend(body);
        let options = options().with_skip_start_magic(true).with_skip_end_magic(true);
        Ok(Self { reader: LinearReader::new_with_options(options), bytes, given: 0 })
    }

    fn feed(&mut self, needs: usize) {
        let count = needs.max(PART).min(self.bytes.len() - self.given);
        self.reader.insert(count).copy_from_slice(&self.bytes[self.given..self.given + count]);
        self.reader.notify_read(count);
        self.given += count;
    }
}

/// Checks that records fill the data of their chunk exactly.
fn check_records(mut data: &[u8]) -> Result<(), McapError> {
    while !data.is_empty() {
        let length = data.get(1..HEAD).and_then(|length| length.try_into().ok()).map(u64::from_le_bytes);
        let length = length.and_then(|length| usize::try_from(length).ok()?.checked_add(HEAD));
        data = length.and_then(|length| data.get(length..)).ok_or(McapError::UnexpectedEoc)?;
    }
    Ok(())
}

fn options() -> LinearReaderOptions {
    LinearReaderOptions::default().with_validate_chunk_crcs(true).with_record_length_limit(LONGEST_RECORD)
}

#[derive(Clone, Debug, PartialEq)]
struct Channel {
    topic: String,
    kind: String,
    encoding: String,
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}, {})", self.topic, self.kind, self.encoding)
    }
}

impl McapBag {
    pub(crate) fn open(path: &Path, wanted: Option<&str>) -> Result<Self, LogError> {
        let wrong = |error| LogError::file(path, format_args!("the file cannot be read: {error}"));
        let file = File::open(path).map_err(wrong)?;
        let size = file.metadata().map_err(wrong)?.len();
        Ok(Self {
            path: path.to_owned(),
            file,
            size,
            given: 0,
            read: 0,
            reader: LinearReader::new_with_options(options().with_emit_chunks(true)),
            chunk: None,
            wanted: wanted.map(str::to_owned),
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            topic: None,
            count: 0,
            ended: false,
        })
    }

    /// Registers a new channel, and chooses it as the topic if it is the one to read.
    fn begin(&mut self, number: u16, channel: Channel) -> Result<(), LogError> {
        let wrong = |what: String| Err(LogError::file(&self.path, what));
        if let Some(known) = self.channels.get(&number) {
            if *known == channel {
                return Ok(());
            }
            return wrong(format!(
                "channel {number} is defined twice, as {known} and as {channel}, so rne cannot know to which of the \
                 two its messages belong; `mcap recover` or a new recording makes a file that can be read"
            ));
        }
        let is_meant = match &self.wanted {
            Some(wanted) => *wanted == channel.topic,
            None => is_joint_state(&channel.kind),
        };
        let (name, encoding) = (channel.topic.clone(), channel.encoding.clone());
        if self.topic.as_ref() == Some(&name) && !is_joint_state(&channel.kind) {
            return wrong(format!("the topic {name} has joint states, but has {} in channel {number}", channel.kind));
        }
        self.channels.insert(number, channel);
        if !is_meant {
            return Ok(());
        }
        if self.topic.as_ref() != Some(&name) {
            topic::choose(&self.path, &self.pairs(), self.wanted.as_deref())?;
        }
        if encoding != "cdr" {
            return Err(LogError::file(
                &self.path,
                format_args!("the topic {name} is encoded as {encoding:?}, not as cdr"),
            ));
        }
        self.topic = Some(name);
        Ok(())
    }

    /// Refuses long names of topics, types and encodings, because they are kept in memory.
    fn check_length(&self, name: &str) -> Result<(), LogError> {
        if name.len() <= LONGEST_NAME {
            return Ok(());
        }
        let what = format!(
            "the name of a topic, its type or its encoding has {} bytes; rne reads names of at most {LONGEST_NAME} \
             bytes",
            name.len()
        );
        Err(LogError::file(&self.path, what))
    }

    /// Refuses bytes after the end of the bag, as from two bags in one file, because they would not be read.
    fn check_end(&self) -> Result<(), LogError> {
        let end = self.read + 2 * mcap::MAGIC.len() as u64;
        if self.size <= end {
            return Ok(());
        }
        let (size, count) = (self.size, self.count);
        let what = format!(
            "the bag ends at byte {end} of {size}, after {count} joint states, and rne does not read the bytes after \
             it: if they are another bag, split the file and name both files"
        );
        Err(LogError::file(&self.path, what))
    }

    fn pairs(&self) -> Vec<(String, String)> {
        let mut pairs: Vec<_> =
            self.channels.values().map(|channel| (channel.topic.clone(), channel.kind.clone())).collect();
        pairs.sort();
        pairs.dedup();
        pairs
    }

    fn wrong(&self, error: &McapError) -> LogError {
        let (given, count) = (self.given, self.count);
        let at = format!("before byte {given} of {}, after {count} joint states", self.size);
        LogError::file(
            &self.path,
            match error {
                McapError::UnexpectedEof if self.chunk.is_none() => {
                    format!(
                        "the file is cut off: it ends within a record, {at}; `mcap recover` keeps the undamaged records"
                    )
                }
                McapError::RecordTooLarge { len, .. } => {
                    format!("a record of {len} bytes, {at}: the file is corrupt, or has larger messages than rne reads")
                }
                McapError::ChunkTooLarge(bytes) => {
                    format!(
                        "a chunk states that it unpacks to {bytes} bytes, {at}: rne reads at most {MOST_UNPACKED} \
                         times the size of the chunk"
                    )
                }
                McapError::UnsupportedCompression(name) => {
                    format!("chunks are compressed with {name:?}: rne reads only zstd and lz4")
                }
                error => format!("the file is corrupt {at}: {error}"),
            },
        )
    }
}

/// An event of the reader, without its borrowed data.
enum Event {
    Needs(usize),
    Chunk(Box<Chunk>),
    Schema(u16, String),
    Channel(u16, u16, String, String),
    State(Result<(), String>),
    Other,
}

impl McapBag {
    fn event(&mut self, sample: &mut Sample) -> Result<Option<Event>, McapError> {
        let is_outside = self.chunk.is_none();
        let reader = self.chunk.as_mut().map_or(&mut self.reader, |chunk| &mut chunk.reader);
        let Some(event) = reader.next_event() else { return Ok(None) };
        let (opcode, data) = match event? {
            LinearReadEvent::ReadRequest(needs) => return Ok(Some(Event::Needs(needs))),
            LinearReadEvent::Record { opcode, data } => (opcode, data),
        };
        if is_outside {
            self.read += (HEAD + data.len()) as u64;
        }
        if opcode == op::CHUNK {
            return Ok(Some(Event::Chunk(Box::new(Chunk::of(data)?))));
        }
        if !matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) {
            return Ok(Some(Event::Other));
        }
        Ok(Some(match mcap::parse_record(opcode, data)? {
            Record::Schema { header, .. } => Event::Schema(header.id, header.name),
            Record::Channel(channel) => {
                Event::Channel(channel.id, channel.schema_id, channel.topic, channel.message_encoding)
            }
            Record::Message { header, data } => {
                let Some(channel) = self.channels.get(&header.channel_id) else {
                    return Err(McapError::UnknownChannel(header.sequence, header.channel_id));
                };
                if self.topic.as_ref() != Some(&channel.topic) {
                    return Ok(Some(Event::Other));
                }
                Event::State(if data.len() > LONGEST_MESSAGE {
                    Err(format!("it has {} bytes", data.len()))
                } else {
                    let recorded = i64::try_from(header.log_time).unwrap_or(i64::MAX);
                    joint_state::decode(&data, recorded, sample)
                })
            }
            _ => Event::Other,
        }))
    }
}

impl Source for McapBag {
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
        while !self.ended {
            let event = guarded(|| self.event(sample)).unwrap_or(Err(McapError::UnexpectedEoc));
            match event.map_err(|error| self.wrong(&error))? {
                None if self.chunk.is_some() => self.chunk = None,
                None => {
                    self.ended = true;
                    self.check_end()?;
                }
                Some(Event::Chunk(chunk)) => self.chunk = Some(chunk),
                Some(Event::Needs(needs)) => {
                    if let Some(chunk) = &mut self.chunk {
                        chunk.feed(needs);
                        continue;
                    }
                    let buffer = self.reader.insert(needs.max(PART));
                    let count = loop {
                        match self.file.read(buffer) {
                            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                            Err(error) => return Err(self.wrong(&McapError::Io(error))),
                            Ok(count) => break count,
                        }
                    };
                    self.given += count as u64;
                    self.reader.notify_read(count);
                }
                Some(Event::Schema(number, name)) => {
                    self.check_length(&name)?;
                    let known = self.schemas.entry(number).or_insert_with(|| name.clone());
                    if *known != name {
                        let what = format!("schema {number} is defined twice, as {known} and as {name}");
                        return Err(LogError::file(&self.path, what));
                    }
                }
                Some(Event::Channel(number, schema, topic, encoding)) => {
                    self.check_length(&topic)?;
                    self.check_length(&encoding)?;
                    let kind = self.schemas.get(&schema).cloned().unwrap_or_else(|| "no type".to_owned());
                    self.begin(number, Channel { topic, kind, encoding })?;
                }
                Some(Event::State(state)) => {
                    self.count += 1;
                    state.map_err(|what| {
                        let topic = self.topic.as_deref().unwrap_or_default();
                        let what = format!("message {} of {topic} cannot be read: {what}", self.count);
                        LogError::file(&self.path, what)
                    })?;
                    return Ok(true);
                }
                Some(Event::Other) => {}
            }
        }
        if self.topic.is_none() {
            topic::choose(&self.path, &self.pairs(), self.wanted.as_deref())?;
        }
        Ok(false)
    }

    #[expect(clippy::cast_precision_loss, reason = "a bar of some hundred steps")]
    fn progress(&self) -> f64 {
        (self.given as f64 / self.size.max(1) as f64).min(1.0)
    }

    fn topic(&self) -> Option<&str> {
        self.topic.as_deref()
    }
}
