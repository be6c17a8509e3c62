//! Keeper of the default sound device: opens it and reopens it after a loss.

use super::mailbox::{Mailbox, SoundError, lock};
use super::source::Source;
use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{Device, ErrorKind, FromSample, I24, SampleFormat, SizedSample, StreamConfig, U24};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Mutex, Weak};
use std::thread;
use std::time::Duration;

/// Time after which a device that does not answer counts as missing.
pub(super) const PATIENCE: Duration = Duration::from_secs(3);

/// Pause between two attempts to open a device.
pub(super) const PAUSE: Duration = Duration::from_secs(2);

/// Keeps a device open until the speaker is dropped. After the first attempt to open it, drops `opened`,
/// because [`Speaker::open`](super::Speaker::open) waits for that.
pub(super) fn keep_open<Stream>(
    mailbox: &Weak<Mutex<Mailbox>>,
    opened: Sender<()>,
    open: impl Fn(Sender<SoundError>) -> Result<Stream, SoundError>,
) {
    let mut opened = Some(opened);
    while mailbox.strong_count() > 0 {
        let (lost, losses) = mpsc::channel();
        let stream = open(lost);
        report(mailbox, stream.as_ref().err().cloned());
        drop(opened.take());
        while stream.is_ok() && mailbox.strong_count() > 0 {
            match losses.recv_timeout(PAUSE) {
                Err(RecvTimeoutError::Timeout) => {}
                Ok(why) => {
                    report(mailbox, Some(why));
                    break;
                }
                Err(RecvTimeoutError::Disconnected) => {
                    report(mailbox, Some(SoundError::NoAnswer));
                    break;
                }
            }
        }
        drop(stream);
        thread::sleep(PAUSE);
    }
}

pub(super) fn report(mailbox: &Weak<Mutex<Mailbox>>, trouble: Option<SoundError>) {
    if let Some(mailbox) = mailbox.upgrade() {
        let mut mailbox = lock(&mailbox);
        mailbox.cues.clear();
        mailbox.trouble = trouble;
    }
}

/// Opens a stream on the default device. The stream plays until it is dropped. If the device is lost, the
/// error is sent to `lost`.
pub(super) fn open_stream(
    mailbox: &Weak<Mutex<Mailbox>>,
    lost: Sender<SoundError>,
) -> Result<cpal::Stream, SoundError> {
    // Stops ALSA from printing an error for each failed attempt. Relevant errors are returned.
    #[cfg(target_os = "linux")]
    let _ = alsa::Output::local_error_handler();
    let device = cpal::default_host()
        .default_output_device()
        .ok_or(SoundError::NoDevice)?;
    let supported = device.default_output_config()?;
    // Uses the default buffer size: ALSA's PulseAudio plugin stalls with other sizes.
    let config = supported.config();
    let source = Source::new(mailbox.clone(), config.sample_rate);
    let build = match supported.sample_format() {
        SampleFormat::I8 => build::<i8>,
        SampleFormat::I16 => build::<i16>,
        SampleFormat::I24 => build::<I24>,
        SampleFormat::I32 => build::<i32>,
        SampleFormat::I64 => build::<i64>,
        SampleFormat::U8 => build::<u8>,
        SampleFormat::U16 => build::<u16>,
        SampleFormat::U24 => build::<U24>,
        SampleFormat::U32 => build::<u32>,
        SampleFormat::U64 => build::<u64>,
        SampleFormat::F32 => build::<f32>,
        SampleFormat::F64 => build::<f64>,
        other => return Err(SoundError::Refused(format!("sample format {other}"))),
    };
    let stream = build(&device, config, source, lost)?;
    stream.play()?;
    Ok(stream)
}

fn build<T: SizedSample + FromSample<f32>>(
    device: &Device,
    config: StreamConfig,
    mut source: Source,
    lost: Sender<SoundError>,
) -> Result<cpal::Stream, cpal::Error> {
    let channels = usize::from(config.channels);
    device.build_output_stream(
        config,
        move |out: &mut [T], _| source.fill(out, channels),
        move |error| match error.kind() {
            // Ignores these errors, because playback continues after them.
            ErrorKind::DeviceChanged | ErrorKind::Xrun | ErrorKind::RealtimeDenied => {}
            // Sending fails if the keeper has already closed the channel, and then nothing more is to be
            // done.
            _ => drop(lost.send(error.into())),
        },
        Some(PATIENCE),
    )
}

impl From<cpal::Error> for SoundError {
    fn from(error: cpal::Error) -> Self {
        match error.kind() {
            ErrorKind::DeviceNotAvailable | ErrorKind::HostUnavailable => Self::NoDevice,
            ErrorKind::DeviceBusy => Self::Busy,
            _ => Self::Refused(error.to_string()),
        }
    }
}
