//! A peer: a program that renders the exported scene, as it is asked to line by line.
//!
//! It says who it is in its first line, then answers each request, a JSON object on a line, by another (`peers/mitsuba_error.py`
//! has the protocol). Images go by way of a file.

use std::cell::RefCell;
use std::fs;
use std::io::{BufRead, BufReader, ErrorKind, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::rc::Rc;

use anyhow::{Context, Result, anyhow, bail, ensure};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::contender::{Contender, Label, Rendered};

/// What a peer says of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hello {
    /// Its name.
    pub renderer: String,
    /// Name and version of what renders.
    pub variant: String,
    /// Its samplers.
    pub samplers: Vec<String>,
    /// What users should know, such as why it is not another variant.
    pub notes: Vec<String>,
}

/// A running peer.
pub struct Peer {
    hello: Hello,
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
    folder: TempDir,
    pixels: usize,
}

/// A peer that was asked to start.
pub enum Started {
    /// It is ready.
    Ready(Peer),
    /// It is not installed: why, in a line.
    Missing(String),
}

impl Peer {
    /// Starts the program, which renders images of so many pixels.
    ///
    /// # Errors
    /// If it runs but does not speak the protocol.
    pub fn start(command: &mut Command, pixels: usize) -> Result<Started> {
        let program = command.get_program().to_string_lossy().into_owned();
        let spawned = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = match spawned {
            Ok(child) => child,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Ok(Started::Missing(format!("there is no {program}")));
            }
            Err(error) => return Err(error).context(program),
        };
        let requests = child.stdin.take().expect("it is piped");
        let answers = BufReader::new(child.stdout.take().expect("it is piped"));
        let mut peer = Self {
            hello: Hello {
                renderer: program,
                variant: String::new(),
                samplers: Vec::new(),
                notes: Vec::new(),
            },
            child,
            requests,
            answers,
            folder: tempfile::tempdir()?,
            pixels,
        };
        let first = peer.read()?;
        if let Some(reason) = first["missing"].as_str() {
            return Ok(Started::Missing(reason.to_owned()));
        }
        peer.hello = Hello::from_json(&first)
            .with_context(|| format!("{}: {first} is no greeting", peer.hello.renderer))?;
        Ok(Started::Ready(peer))
    }

    /// What it says of itself.
    pub fn hello(&self) -> &Hello {
        &self.hello
    }

    /// The next line. A peer that says something else first (libraries do) is listened to until it comes to the point.
    fn read(&mut self) -> Result<Value> {
        let mut line = String::new();
        loop {
            line.clear();
            if self.answers.read_line(&mut line)? == 0 {
                let status = self.child.wait()?;
                bail!("{} ended without an answer: {status}", self.hello.renderer);
            }
            match serde_json::from_str(&line) {
                Ok(answer @ Value::Object(_)) => return Ok(answer),
                _ => eprint!("{}: {line}", self.hello.renderer),
            }
        }
    }

    /// Renders an image.
    fn render(&mut self, sampler: &str, samples: u32, seed: u32) -> Result<Rendered> {
        let path = self.folder.path().join("image.f32");
        let request = json!({
            "sampler": sampler,
            "samples": samples,
            "seed": seed,
            "image": path,
        });
        // Where the peer has ended, reading says how.
        let _ = writeln!(self.requests, "{request}").and_then(|()| self.requests.flush());
        let answer = self.read()?;
        if let Some(error) = answer["error"].as_str() {
            bail!("{error}");
        }
        let cpu_s = answer["cpu_s"].as_f64().filter(|&s| s > 0.0);
        let taken = answer["samples"]
            .as_u64()
            .and_then(|n| u32::try_from(n).ok());
        let (Some(cpu_s), Some(samples)) = (cpu_s, taken) else {
            bail!("{answer} is no answer");
        };
        let bytes = fs::read(&path).context("reading its image")?;
        fs::remove_file(&path)?;
        let image = image(&bytes, self.pixels)?;
        Ok(Rendered {
            image,
            samples,
            cpu_s,
        })
    }
}

impl Drop for Peer {
    /// Ends the program.
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Hello {
    fn from_json(value: &Value) -> Result<Self> {
        let text = |key: &str| {
            let text = value[key].as_str().map(str::to_owned);
            text.ok_or_else(|| anyhow!("no {key:?}"))
        };
        let list = |key: &str| {
            let items = value[key].as_array().into_iter().flatten();
            items
                .filter_map(|item| item.as_str().map(str::to_owned))
                .collect::<Vec<_>>()
        };
        let hello = Self {
            renderer: text("renderer")?,
            variant: format!("{}, {}", text("version")?, text("variant")?),
            samplers: list("samplers"),
            notes: list("notes"),
        };
        ensure!(!hello.samplers.is_empty(), "no \"samplers\"");
        Ok(hello)
    }
}

/// An image of 32-bit floats.
fn image(bytes: &[u8], pixels: usize) -> Result<Vec<[f32; 3]>> {
    ensure!(
        bytes.len() == 12 * pixels,
        "an image of {pixels} pixels has {} bytes, not {}",
        12 * pixels,
        bytes.len()
    );
    let number = |bytes: &[u8; 4]| f32::from_le_bytes(*bytes);
    let (numbers, _) = bytes.as_chunks::<4>();
    let (colors, _) = numbers.as_chunks::<3>();
    let image: Vec<_> = colors
        .iter()
        .map(|color| color.each_ref().map(number))
        .collect();
    ensure!(
        image.as_flattened().iter().all(|c| c.is_finite()),
        "its image has pixels that are not finite"
    );
    Ok(image)
}

/// A peer with one of its samplers.
pub struct PeerSampler {
    peer: Rc<RefCell<Peer>>,
    sampler: String,
}

impl PeerSampler {
    /// A contender for each sampler of a peer.
    pub fn all(peer: Peer) -> Vec<Self> {
        let samplers = peer.hello().samplers.clone();
        let peer = Rc::new(RefCell::new(peer));
        let of = |sampler| Self {
            peer: peer.clone(),
            sampler,
        };
        samplers.into_iter().map(of).collect()
    }
}

impl Contender for PeerSampler {
    fn label(&self) -> Label {
        let peer = self.peer.borrow();
        Label {
            renderer: peer.hello.renderer.clone(),
            variant: peer.hello.variant.clone(),
            sampler: self.sampler.clone(),
        }
    }

    fn render(&mut self, samples: u32, seed: u32) -> Result<Rendered> {
        self.peer.borrow_mut().render(&self.sampler, samples, seed)
    }
}
