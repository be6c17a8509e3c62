//! Levels that travel: by name where they come along, else whole.

use super::error::{LinkError, all};
use crate::assists::assisted;
use crate::level::{LevelError, hash_of, plain, text_of};
use crate::replay::MAX_NAME;
use crate::{Assist, Level};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::BodyText;
use miniz_oxide::{deflate, inflate};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Most bytes of a scene in one before they are deflated: an honest one that fits is smaller.
pub(super) const MAX_SCENE_BYTES: usize = 1 << 17;
/// How hard deflate looks for repetitions, 0 to 10.
pub(super) const EFFORT: u8 = 9;

/// A level on its way.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct SentLevel {
    pub(super) id: String,
    pub(super) content: Content,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Content {
    /// It comes along, with some things made easier.
    Known {
        assists: BTreeSet<Assist>,
        /// Half of its hash.
        hash: u32,
    },
    /// A [`WholeScene`], deflated.
    Whole(Vec<u8>),
}

impl SentLevel {
    pub(super) fn of(id: &str, scene: &Scene) -> Result<Self, LinkError> {
        let assists = scene.game.iter().flat_map(|game| &game.assists);
        let assists: BTreeSet<Assist> = assists.copied().collect();
        let known = Level::open(id).map(|level| assisted(level.scene(), &assists));
        let content = match known {
            Ok(known) if known == *scene => Content::Known {
                assists,
                hash: hash_of(scene) as u32,
            },
            _ => Content::Whole(deflated(id, scene)?),
        };
        let id = id.into();
        Ok(Self { id, content })
    }

    pub(super) fn read(bytes: &[u8]) -> Result<Level, LinkError> {
        let sent: Self = all(bytes)?;
        if sent.id.chars().count() > MAX_NAME {
            return Err(LinkError::Damaged);
        }
        // One that somebody made never takes the place of one that comes along.
        let is_made = matches!(sent.content, Content::Whole(_)) && !sent.id.contains('.');
        let id = sent.id.clone() + if is_made { ".toml" } else { "" };
        Ok(Level::of(&id, plain(sent.scene()?))?)
    }

    pub(super) fn scene(&self) -> Result<Scene, LinkError> {
        match &self.content {
            Content::Known { assists, hash } => {
                let scene = assisted(Level::open(&self.id)?.scene(), assists);
                let is_same = hash_of(&scene) as u32 == *hash;
                let differs = || LinkError::LevelDiffers(self.id.clone());
                is_same.then_some(scene).ok_or_else(differs)
            }
            Content::Whole(deflated) => inflated(&self.id, deflated),
        }
    }
}

/// The text of a scene without the files that its bodies are made from, and those: their bytes are told in less room than
/// their letters.
pub(super) type WholeScene = (String, Vec<Option<Vec<u8>>>);

fn deflated(id: &str, scene: &Scene) -> Result<Vec<u8>, LinkError> {
    let mut scene = scene.clone();
    let files = scene.body.iter_mut().map(take_file).collect();
    let whole: WholeScene = (text_of(&scene), files);
    let bytes = postcard::to_stdvec(&whole).expect("a vector takes all");
    let found = bytes.len();
    if found > MAX_SCENE_BYTES {
        let reason = format!("for a link, expected {MAX_SCENE_BYTES} bytes at most, found {found}");
        return Err(LevelError::Unreadable(id.into(), reason).into());
    }
    Ok(deflate::compress_to_vec(&bytes, EFFORT))
}

fn inflated(id: &str, deflated: &[u8]) -> Result<Scene, LinkError> {
    let bytes = inflate::decompress_to_vec_with_limit(deflated, MAX_SCENE_BYTES);
    let (text, files): WholeScene = all(&bytes.map_err(|_| LinkError::Damaged)?)?;
    let mut scene = Scene::read(id, &text, &[]).map_err(LevelError::Scene)?;
    for (body, file) in scene.body.iter_mut().zip(files) {
        body.content = file
            .map(|bytes| BASE64_STANDARD.encode(bytes))
            .or(body.content.take());
    }
    Ok(scene)
}

/// Takes out the bytes of the file that a body is made from; what is no base64 stays.
fn take_file(body: &mut BodyText) -> Option<Vec<u8>> {
    let bytes = BASE64_STANDARD.decode(body.content.as_ref()?).ok()?;
    body.content = None;
    Some(bytes)
}
