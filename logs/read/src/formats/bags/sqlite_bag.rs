//! Bags of ROS 2 in SQLite: `*.db3`.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use rusqlite::limits::Limit;
use rusqlite::{Connection, OpenFlags, OptionalExtension as _};

use crate::LogError;
use crate::formats::bags::joint_state;
use crate::formats::bags::topic;
use crate::formats::sample::{Sample, Source};
use crate::limits::MOST_BYTES;

/// Number of messages that are read by one query. The next query continues after the last message, because a struct
/// cannot own a statement together with its connection.
const BATCH: u32 = 1024;

/// Query for messages in the order of time. It returns no data for messages that are too long, only their length.
const BY_TIME: &str = "SELECT timestamp, id, length(data), CASE WHEN length(data) <= ?5 THEN data END FROM messages \
                       WHERE topic_id = ?1 AND (timestamp, id) > (?2, ?3) ORDER BY timestamp, id LIMIT ?4";

/// Query for a bag without an index of times, in the order of numbers: sorting the bag for each query would take too
/// long.
const BY_NUMBER: &str = "SELECT timestamp, id, length(data), CASE WHEN length(data) <= ?5 THEN data END FROM messages \
                         WHERE topic_id = ?1 AND id > ?3 AND ?2 IS NOT NULL ORDER BY id LIMIT ?4";

/// Largest number of bytes of a message with joint states.
const LONGEST_MESSAGE: i32 = 1 << 20;

/// The first bytes of a file of SQLite.
const MAGIC: &[u8] = b"SQLite format 3\0";

/// A bag, read in the order of the recording times or, without an index of them, in the order of writing.
pub(crate) struct SqliteBag {
    path: PathBuf,
    connection: Connection,
    /// The file that SQLite makes next to the bag, which is removed at the end.
    _rest: Rest,
    topic: String,
    topic_id: i64,
    query: &'static str,
    /// Time and number of the last message that was read.
    last: (i64, i64),
    /// The first and the last time in all topics, ns.
    span: (i64, i64),
    batch: Vec<Sample>,
    next: usize,
    at_end: bool,
    count: u64,
}

impl SqliteBag {
    pub(crate) fn open(path: &Path, wanted: Option<&str>) -> Result<Self, LogError> {
        let head = head(path)?;
        let (connection, rest) = connect(path, &head).map_err(|error| unreadable(path, &error))?;
        let topics = topics(path, &connection)?;
        let pairs: Vec<(String, String)> = topics.iter().map(|topic| (topic.1.clone(), topic.2.clone())).collect();
        let place = topic::choose(path, &pairs, wanted)?;
        let (topic_id, name, _, encoding) = topics[place].clone();
        if encoding != "cdr" {
            return Err(LogError::file(path, format_args!("the topic {name} is encoded as {encoding:?}, not as cdr")));
        }
        let edge = |order: &str| {
            let query = format!("SELECT timestamp FROM messages ORDER BY timestamp {order} LIMIT 1");
            connection.query_row(&query, [], |row| row.get::<_, i64>(0)).optional()
        };
        let span = match (edge("ASC"), edge("DESC")) {
            (Ok(first), Ok(last)) => (first.unwrap_or(0), last.unwrap_or(0)),
            (Err(error), _) | (_, Err(error)) => return Err(unreadable(path, &error)),
        };
        let is_indexed = "SELECT count(*) FROM pragma_index_list('messages') AS list, \
                          pragma_index_info(list.name) AS info \
                          WHERE info.seqno = 0 AND info.name = 'timestamp'";
        let indices: i64 =
            connection.query_row(is_indexed, [], |row| row.get(0)).map_err(|error| unreadable(path, &error))?;
        Ok(Self {
            query: if indices > 0 { BY_TIME } else { BY_NUMBER },
            path: path.to_owned(),
            connection,
            _rest: rest,
            topic: name,
            topic_id,
            last: (i64::MIN, i64::MIN),
            span,
            batch: Vec::new(),
            next: 0,
            at_end: false,
            count: 0,
        })
    }

    fn fill(&mut self) -> Result<(), LogError> {
        self.next = 0;
        self.batch.clear();
        let before = self.count;
        let wrong = |error: rusqlite::Error| {
            LogError::file(&self.path, format_args!("{}, after {before} messages or more", reason(&error)))
        };
        let mut statement = self.connection.prepare(self.query).map_err(wrong)?;
        let mut rows =
            statement.query((self.topic_id, self.last.0, self.last.1, BATCH, LONGEST_MESSAGE)).map_err(wrong)?;
        let mut size = 0;
        while let Some(row) = rows.next().map_err(wrong)? {
            self.last = (row.get(0).map_err(wrong)?, row.get(1).map_err(wrong)?);
            let length: Option<i64> = row.get(2).map_err(wrong)?;
            let data = row.get_ref(3).map_err(wrong)?;
            let what = match data.as_blob() {
                Ok(bytes) => {
                    let mut sample = Sample::default();
                    joint_state::decode(bytes, self.last.0, &mut sample).map(|()| {
                        size += sample.size();
                        self.batch.push(sample);
                    })
                }
                Err(_) if length.is_some_and(|length| length > i64::from(LONGEST_MESSAGE)) => {
                    Err(format!("it has {} bytes", length.unwrap_or_default()))
                }
                Err(_) => Err(format!("its data is {}, not bytes", data.data_type())),
            };
            self.count += 1;
            what.map_err(|what| {
                let (count, topic) = (self.count, &self.topic);
                LogError::file(&self.path, format_args!("message {count} of {topic} cannot be read: {what}"))
            })?;
            if size > MOST_BYTES {
                return Ok(());
            }
        }
        self.at_end = self.batch.len() < BATCH as usize;
        Ok(())
    }
}

impl Source for SqliteBag {
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError> {
        if self.next == self.batch.len() {
            if self.at_end {
                return Ok(false);
            }
            self.fill()?;
        }
        let Some(next) = self.batch.get_mut(self.next) else { return Ok(false) };
        std::mem::swap(next, sample);
        self.next += 1;
        Ok(true)
    }

    #[expect(clippy::cast_precision_loss, reason = "a bar of some hundred steps")]
    fn progress(&self) -> f64 {
        let (first, last) = self.span;
        let all = last.saturating_sub(first).max(1) as f64;
        (self.last.0.saturating_sub(first) as f64 / all).clamp(0.0, 1.0)
    }

    fn topic(&self) -> Option<&str> {
        Some(&self.topic)
    }
}

/// Returns the head of a file. Refuses a file that is shorter than its head states, because SQLite would read the
/// missing part of the last page as zeros.
fn head(path: &Path) -> Result<[u8; 100], LogError> {
    let wrong = |error| LogError::file(path, format_args!("the file cannot be read: {error}"));
    let mut file = File::open(path).map_err(wrong)?;
    let length = file.metadata().map_err(wrong)?.len();
    let mut head = [0; 100];
    if file.read_exact(&mut head).is_err() {
        return Err(LogError::file(
            path,
            format_args!("the bag is cut off: it has {length} bytes, less than its header"),
        ));
    }
    let number = |at: usize| u64::from(u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]));
    let page = match u64::from(u16::from_be_bytes([head[16], head[17]])) {
        1 => 65_536,
        page => page,
    };
    // the number of pages is valid only if these two counters of changes are equal
    let wanted = if number(24) == number(92) { page * number(28) } else { 0 };
    if length < wanted {
        return Err(LogError::file(path, format_args!("the bag is cut off: it has {length} bytes of {wanted}")));
    }
    let mut next = [0; MAGIC.len()];
    if wanted > 0
        && length > wanted
        && file.seek(SeekFrom::Start(wanted)).and_then(|_| file.read_exact(&mut next)).is_ok()
        && next == MAGIC
    {
        let what = format!(
            "the bag ends at byte {wanted} of {length}, and another bag follows, which rne does not read: split the \
             file and name both files"
        );
        return Err(LogError::file(path, what));
    }
    Ok(head)
}

/// A file that SQLite makes next to a bag to read it. It is removed when the bag is closed; `None` if it existed
/// before.
struct Rest(Option<PathBuf>);

impl Drop for Rest {
    fn drop(&mut self) {
        if let Some(path) = &self.0 {
            let _ = std::fs::remove_file(path);
        }
    }
}

/// Returns the name of a file next to a bag: the bag's name with this ending.
fn beside(path: &Path, end: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(end);
    name.into()
}

/// Opens the bag such that no new file remains next to it.
fn connect(path: &Path, head: &[u8; 100]) -> rusqlite::Result<(Connection, Rest)> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let shared = beside(path, "-shm");
    // a bag whose changes are first written to another file, the write-ahead log (WAL)
    let has_wal = head[18] == 2;
    let is_wal_empty = || std::fs::metadata(beside(path, "-wal")).map_or(true, |wal| wal.len() == 0);
    let (connection, rest) = if has_wal && is_wal_empty() && !shared.exists() {
        // nobody writes and the WAL is empty: SQLite needs no further file
        let connection = Connection::open_with_flags(unchanging(path), flags | OpenFlags::SQLITE_OPEN_URI)?;
        (connection, Rest(None))
    } else {
        // SQLite makes an index file to read a WAL, unless a writer has made it already
        let rest = Rest((has_wal && !shared.exists()).then_some(shared));
        (Connection::open_with_flags(path, flags)?, rest)
    };
    connection.set_limit(Limit::SQLITE_LIMIT_LENGTH, LONGEST_MESSAGE + 4096)?;
    // code in the file's schema is not run, and pages are checked
    connection.execute_batch("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA query_only = ON;")?;
    Ok((connection, rest))
}

/// Returns the URI of a file that tells SQLite that nobody changes the file.
fn unchanging(path: &Path) -> String {
    let text = path.as_os_str().as_encoded_bytes();
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/-_.~".contains(&byte);
    let mut name = "file:".to_owned();
    if path.is_absolute() {
        name.push_str(if cfg!(windows) { "///" } else { "//" });
    }
    for byte in text {
        match byte {
            b'\\' if cfg!(windows) => name.push('/'),
            b':' if cfg!(windows) => name.push(':'),
            byte if is_plain(*byte) => name.push(char::from(*byte)),
            byte => {
                let _ = write!(name, "%{byte:02X}");
            }
        }
    }
    name + "?immutable=1"
}

/// Reads the topics of a bag: number, name, type and encoding.
fn topics(path: &Path, connection: &Connection) -> Result<Vec<(i64, String, String, String)>, LogError> {
    let wrong = |error: rusqlite::Error| unreadable(path, &error);
    let tables = "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('topics', 'messages')";
    let count: i64 = connection.query_row(tables, [], |row| row.get(0)).map_err(wrong)?;
    if count < 2 {
        let what = "the SQLite file has no tables `topics` and `messages`: it is not a bag of ROS 2";
        return Err(LogError::file(path, what));
    }
    let mut statement =
        connection.prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id").map_err(wrong)?;
    let rows =
        statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?))).map_err(wrong)?;
    rows.collect::<Result<_, _>>().map_err(wrong)
}

fn unreadable(path: &Path, error: &rusqlite::Error) -> LogError {
    LogError::file(path, reason(error))
}

/// Returns a message for an error of SQLite.
fn reason(error: &rusqlite::Error) -> String {
    use rusqlite::ErrorCode::{DatabaseCorrupt, NotADatabase, TooBig};
    match error.sqlite_error_code() {
        Some(DatabaseCorrupt) => "the bag is corrupt or cut off (SQLite: database disk image is malformed)".to_owned(),
        Some(NotADatabase) => "the bag is corrupt: it begins like a SQLite file, but the rest is not SQLite".to_owned(),
        Some(TooBig) => format!("a message has more than {LONGEST_MESSAGE} bytes"),
        _ => format!("the bag cannot be read: {error}"),
    }
}
