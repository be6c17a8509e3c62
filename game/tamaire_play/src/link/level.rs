//! Levels in links. A built-in level is sent by name, any other level in full.

use super::error::{LinkError, all};
use crate::assists::assisted;
use crate::level::{LevelError, hash_of, text_of, without_assists};
use crate::replay::MAX_NAME;
use crate::{Assist, Level};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::BodyText;
use miniz_oxide::{deflate, inflate};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Maximum size of a scene in a link before compression [bytes]. It stops links that decompress to huge
/// texts; any real scene that fits into a link is smaller.
pub(super) const MAX_SCENE_BYTES: usize = 1 << 17;
/// Compression level of deflate, 0 to 10.
pub(super) const EFFORT: u8 = 9;

/// Encoded level.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct SentLevel {
    pub(super) id: String,
    pub(super) content: Content,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Content {
    /// A built-in level, sent by its name and its assists.
    Known {
        assists: BTreeSet<Assist>,
        /// Lower half of the level's hash, which detects a different level of the same name.
        hash: u32,
    },
    /// Any other level, as a deflated [`WholeScene`].
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
        // Appends a file extension to the name of a custom level, so that it cannot take the name of a
        // built-in level.
        let is_made = matches!(sent.content, Content::Whole(_)) && !sent.id.contains('.');
        let id = sent.id.clone() + if is_made { ".toml" } else { "" };
        Ok(Level::from_scene(&id, without_assists(sent.scene()?))?)
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

/// Text of a scene and the files of its bodies. The files are sent as bytes, which are shorter than base64 in
/// the text.
pub(super) type WholeScene = (String, Vec<Option<Vec<u8>>>);

fn deflated(id: &str, scene: &Scene) -> Result<Vec<u8>, LinkError> {
    let mut scene = scene.clone();
    let files = scene.body.iter_mut().map(take_file).collect();
    let whole: WholeScene = (text_of(&scene), files);
    let bytes = postcard::to_stdvec(&whole).expect("serialization into a vector cannot fail");
    let found = bytes.len();
    if found > MAX_SCENE_BYTES {
        let reason = format!("for a link, expected at most {MAX_SCENE_BYTES} bytes, found {found}");
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

/// Removes the embedded file from a body and returns the file's bytes. Content that is not base64 stays in
/// the body.
fn take_file(body: &mut BodyText) -> Option<Vec<u8>> {
    let bytes = BASE64_STANDARD.decode(body.content.as_ref()?).ok()?;
    body.content = None;
    Some(bytes)
}
