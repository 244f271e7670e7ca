//! Message frames: what stands between the byte streams and the service.
//!
//! The library ends the conversation at the first message that it cannot read (its frame reader stops
//! after an error). So messages are checked here: what is broken is answered with an error here, and
//! the service sees only messages that it can read.

use std::io::{self, Write};

use tokio::io::{
    AsyncBufRead, AsyncBufReadExt, AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt, BufReader,
};
use tokio::sync::mpsc;
use tokio::task::JoinHandle;
use tower_lsp::jsonrpc::{Error, Id, Request, Response};

use super::Ending;
use super::parcels::{self, Parcels};

/// A longer message is refused and skipped (bytes).
const MESSAGE_LIMIT: u64 = 1 << 30;

/// A longer header line is no header line (bytes).
const HEADER_LINE_LIMIT: u64 = 8 << 10;

/// Frames waiting for the client to read them before the service waits.
const WAITING_FRAMES: usize = 64;

/// The bodies of messages that the client has not read yet.
pub(super) struct Outgoing {
    /// Where they are put in.
    pub frames: mpsc::Sender<Vec<u8>>,
    waiting: Waiting,
}

/// Where the bodies come out again.
pub(super) type Waiting = mpsc::Receiver<Vec<u8>>;

impl Outgoing {
    /// None yet.
    pub(super) fn new() -> Self {
        let (frames, waiting) = mpsc::channel(WAITING_FRAMES);
        Self { frames, waiting }
    }
}

/// How long unfinished answers may take after the end of input.
const LAST_ANSWERS: std::time::Duration = std::time::Duration::from_secs(2);

/// Moves frames both ways, out by a writer, until `exit` or the end of input.
pub(super) async fn run(
    input: impl AsyncRead + Unpin + Send + 'static,
    to_service: impl AsyncWrite + Unpin + Send + 'static,
    from_service: impl AsyncRead + Unpin + Send + 'static,
    writer: impl FnOnce(Waiting) -> JoinHandle<()>,
    outgoing: Outgoing,
    parcels: Parcels,
) -> Ending {
    let Outgoing { frames, waiting } = outgoing;
    let answers = tokio::spawn(forward_answers(from_service, frames.clone(), parcels));
    let writer = writer(waiting);
    let ending = read_messages(input, to_service, frames).await;
    let _ = tokio::time::timeout(LAST_ANSWERS, async {
        let _ = answers.await;
        let _ = writer.await;
    })
    .await;
    ending
}

/// Reads messages and hands on the good ones; dropping `to_service` at the end tells the service.
async fn read_messages(
    input: impl AsyncRead + Unpin,
    mut to_service: impl AsyncWrite + Unpin,
    answers: mpsc::Sender<Vec<u8>>,
) -> Ending {
    let mut input = BufReader::new(input);
    let mut ending = Ending::Abrupt;
    loop {
        let outcome = match read_frame(&mut input).await {
            Ok(Some(Frame::Message(body))) => check(body),
            Ok(Some(Frame::Broken)) => Err(Error::parse_error()),
            Ok(None) | Err(_) => return ending,
        };
        match outcome {
            Ok(message) => {
                if write_frame(&mut to_service, &message.body).await.is_err() {
                    return ending;
                }
                match message.method.as_str() {
                    "shutdown" => ending = Ending::Orderly,
                    "exit" => return ending,
                    _ => {}
                }
            }
            Err(error) => {
                let response = Response::from_error(Id::Null, error);
                if let Ok(body) = serde_json::to_vec(&response)
                    && answers.send(body).await.is_err()
                {
                    return ending;
                }
            }
        }
    }
}

struct Message {
    body: Vec<u8>,
    method: String,
}

/// Reads a body as the service will. Its answers to our own requests are requests without a method in
/// the library's eyes, so one reading covers both.
fn check(body: Vec<u8>) -> Result<Message, Error> {
    match serde_json::from_slice::<Request>(&body) {
        Ok(request) => Ok(Message { method: request.method().to_owned(), body: for_service(&request, body) }),
        Err(error) if error.is_data() => Err(Error::invalid_request()),
        Err(_) => Err(Error::parse_error()),
    }
}

/// The body of a request as the service is to see it.
fn for_service(request: &Request, body: Vec<u8>) -> Vec<u8> {
    // What has been read can be written.
    parcels::renamed(request).and_then(|renamed| serde_json::to_vec(&renamed).ok()).unwrap_or(body)
}

enum Frame {
    Message(Vec<u8>),
    Broken,
}

/// The next frame; none at the end of input.
async fn read_frame(input: &mut (impl AsyncBufRead + Unpin)) -> io::Result<Option<Frame>> {
    let mut length = None;
    let mut broken = false;
    loop {
        let mut line = Vec::new();
        (&mut *input).take(HEADER_LINE_LIMIT).read_until(b'\n', &mut line).await?;
        if line.is_empty() {
            return Ok(None);
        }
        let header = line.trim_ascii();
        if header.is_empty() {
            if length.is_some() || broken {
                break;
            }
            continue; // Blank lines between messages do no harm.
        }
        match content_length(header) {
            Some(Ok(bytes)) => length = Some(bytes),
            Some(Err(())) => broken = true,
            None if header.contains(&b':') => {}
            None => broken = true,
        }
    }
    let Some(length) = length else { return Ok(Some(Frame::Broken)) };
    if length > MESSAGE_LIMIT {
        tokio::io::copy(&mut input.take(length), &mut tokio::io::sink()).await?;
        return Ok(Some(Frame::Broken));
    }
    // Not allocated in advance: the length is only a claim.
    let mut body = Vec::new();
    input.take(length).read_to_end(&mut body).await?;
    if (body.len() as u64) < length {
        return Ok(None);
    }
    Ok(Some(Frame::Message(body)))
}

/// The value of a `Content-Length` header; none if it is another header.
///
/// After a broken message its rest can stand before the next header in the same line, so the name is
/// looked for, not expected at the beginning.
fn content_length(header: &[u8]) -> Option<Result<u64, ()>> {
    const NAME: &[u8] = b"content-length:";
    let at = header.windows(NAME.len()).rposition(|part| part.eq_ignore_ascii_case(NAME))?;
    let value = header[at + NAME.len()..].trim_ascii();
    Some(std::str::from_utf8(value).ok().and_then(|text| text.parse().ok()).ok_or(()))
}

/// A message in one piece, so that nobody wakes for half of it.
fn frame(body: &[u8]) -> Vec<u8> {
    let header = format!("Content-Length: {}\r\n\r\n", body.len());
    [header.as_bytes(), body].concat()
}

/// Writes a message.
pub(super) async fn write_frame(output: &mut (impl AsyncWrite + Unpin), body: &[u8]) -> io::Result<()> {
    output.write_all(&frame(body)).await?;
    output.flush().await
}

/// Takes the service's frames apart, so that our own answers fall between them and not into them, and those that are
/// only tickets become what they stand for.
async fn forward_answers(
    from_service: impl AsyncRead + Unpin,
    frames: mpsc::Sender<Vec<u8>>,
    parcels: Parcels,
) {
    let mut input = BufReader::new(from_service);
    while let Ok(Some(Frame::Message(body))) = read_frame(&mut input).await {
        if frames.send(parcels.filled(body)).await.is_err() {
            return;
        }
    }
}

/// Writes frames to standard output on a thread of its own: by way of the runtime each would wait for that thread three
/// times.
pub(super) fn to_standard_output(mut waiting: Waiting) -> JoinHandle<()> {
    tokio::task::spawn_blocking(move || {
        let Ok(mut output) = standard_output() else { return };
        while let Some(body) = waiting.blocking_recv() {
            if output.write_all(&frame(&body)).and_then(|()| output.flush()).is_err() {
                return; // The client is gone; the end of input follows.
            }
        }
    })
}

/// Standard output without a buffer, which would divide each message at its last line.
#[cfg(unix)]
fn standard_output() -> io::Result<impl Write> {
    use std::os::fd::AsFd as _;
    Ok(std::fs::File::from(io::stdout().as_fd().try_clone_to_owned()?))
}

#[cfg(not(unix))]
fn standard_output() -> io::Result<impl Write> {
    Ok(io::stdout())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bodies go out in the frames in which they are read.
    #[tokio::test]
    async fn a_frame_is_read_as_it_was_written() {
        let mut written = frame(b"{}");
        written.extend(frame(&[b'x'; 3_000]));
        assert_eq!(frames(&written).await, [good("{}"), Some("x".repeat(3_000))]);
    }

    async fn frames(input: &[u8]) -> Vec<Option<String>> {
        let mut reader = BufReader::new(input);
        let mut frames = Vec::new();
        while let Some(frame) = read_frame(&mut reader).await.unwrap() {
            frames.push(match frame {
                Frame::Message(body) => Some(String::from_utf8(body).unwrap()),
                Frame::Broken => None,
            });
        }
        frames
    }

    fn good(text: &str) -> Option<String> {
        Some(text.to_owned())
    }

    #[tokio::test]
    async fn frames_are_found_again_after_rubbish() {
        let input = b"Content-Length: 2\r\n\r\n{}rubbish\r\n\r\nContent-Length: 3\r\nX: y\r\n\r\nabc";
        assert_eq!(frames(input).await, [good("{}"), None, good("abc")]);
        assert_eq!(frames(b"Content-Length: many\r\n\r\ncontent-length:1\n\n7").await, [None, good("7")]);
        assert_eq!(frames(b"rest{Content-Length: 1\r\n\r\n7").await, [good("7")]);
        assert_eq!(frames(b"\r\n\r\nContent-Length: 1\r\n\r\n7").await, [good("7")]);
    }

    #[tokio::test]
    async fn a_message_that_ends_too_early_is_the_end() {
        assert_eq!(frames(b"Content-Length: 999999999\r\n\r\n{}").await, []);
        assert_eq!(frames(b"Content-Length: 99999999999\r\n\r\n{}").await, [None], "too long to be read");
        assert_eq!(frames(b"Content-Length: 10\r\n\r\n{}").await, []);
        assert_eq!(frames(b"Content-Le").await, []);
    }

    #[test]
    fn bodies_are_read_as_the_service_reads_them() {
        let method = |text: &str| check(text.as_bytes().to_vec()).map(|message| message.method);
        assert_eq!(method(r#"{"jsonrpc":"2.0","id":1,"method":"a"}"#), Ok("a".to_owned()));
        assert_eq!(method(r#"{"jsonrpc":"2.0","id":1,"result":{}}"#), Ok(String::new()));
        assert_eq!(method("[]").unwrap_err(), Error::invalid_request());
        assert_eq!(
            method(r#"{"jsonrpc":"2.0","id":1.5,"method":"a"}"#).unwrap_err(),
            Error::invalid_request()
        );
        assert_eq!(method(r#"{"jsonrpc":"2.0","params":"\ud800"}"#).unwrap_err(), Error::parse_error());
        assert_eq!(method(r#"{"jsonrpc":"#).unwrap_err(), Error::parse_error());
        assert_eq!(method("\u{fffd}").unwrap_err(), Error::parse_error());
    }
}
