//! Twists of levels.

use super::mirror::mirrored;
use crate::{Level, Way};
use fuwafuwa_scenes::Scene;
use fuwafuwa_scenes::scene::{LocalizedText, MaterialText};

/// Change of a level.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Twist {
    /// Two fifths of the gravity.
    Moon,
    /// One and a half times the gravity.
    Giant,
    /// Half as stiff.
    Jelly,
    /// Twice as stiff.
    Rubber,
    /// Half as strong and half as tough.
    Biscuit,
    /// Hardly any friction.
    Soap,
    /// Thick air.
    Syrup,
    /// Left and right swapped.
    Mirror,
}

impl Twist {
    /// All twists.
    pub const ALL: [Self; 8] = [
        Self::Moon,
        Self::Giant,
        Self::Jelly,
        Self::Rubber,
        Self::Biscuit,
        Self::Soap,
        Self::Syrup,
        Self::Mirror,
    ];

    /// Returns the name in the list of pairs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moon => "moon",
            Self::Giant => "giant",
            Self::Jelly => "jelly",
            Self::Rubber => "rubber",
            Self::Biscuit => "biscuit",
            Self::Soap => "soap",
            Self::Syrup => "syrup",
            Self::Mirror => "mirror",
        }
    }

    /// Returns the twist with a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|twist| twist.name() == name)
    }

    /// Returns the words that follow the name of a level, in English and Japanese.
    fn title(self) -> [&'static str; 2] {
        match self {
            Self::Moon => ["on the moon", "月の うえで"],
            Self::Giant => ["on a giant planet", "おもい 星で"],
            Self::Jelly => ["made of jelly", "ぷるぷる"],
            Self::Rubber => ["made of rubber", "かちかち"],
            Self::Biscuit => ["made of biscuit", "ほろほろ"],
            Self::Soap => ["with soap", "つるつる"],
            Self::Syrup => ["in syrup", "とろとろの なかで"],
            Self::Mirror => ["in the mirror", "かがみの なかで"],
        }
    }

    /// Returns a level with this twist. `None` if it changes nothing, or cannot be applied to the level.
    pub fn of(self, level: &Level) -> Option<Level> {
        let mut scene = self.scene(level.scene())?;
        if scene == *level.scene() {
            return None;
        }
        let game = scene.game.as_mut()?;
        let [en, ja] = self.title();
        let name = &game.name;
        game.name = LocalizedText {
            en: format!("{} {en}", name.en),
            ja: Some(format!("{} {ja}", name.ja.as_ref().unwrap_or(&name.en))),
        };
        Level::from_scene(&level.id, scene).ok()
    }

    /// Returns a way through the level with this twist.
    pub fn way(self, way: &Way) -> Way {
        let mut way = way.clone();
        if self == Self::Mirror {
            for point in way.path.iter_mut().chain(&mut way.second) {
                point[1] = -point[1];
            }
        }
        way
    }

    fn scene(self, scene: &Scene) -> Option<Scene> {
        let mut scene = scene.clone();
        let usual = fuwafuwa::Material::default();
        let materials = |change: &dyn Fn(&mut MaterialText)| {
            let mut materials = scene.material.clone();
            materials.iter_mut().for_each(change);
            materials
        };
        let stiffer = |factor: f64| {
            materials(&|material: &mut MaterialText| {
                material.young = Some(factor * material.young.unwrap_or(usual.elasticity.young));
            })
        };
        match self {
            Self::Moon => scene.gravity = scene.gravity.map(|k| 0.4 * k),
            Self::Giant => scene.gravity = scene.gravity.map(|k| 1.5 * k),
            Self::Jelly => scene.material = stiffer(0.5),
            Self::Rubber => scene.material = stiffer(2.0),
            Self::Biscuit => {
                scene.material = materials(&|material: &mut MaterialText| {
                    if !material.unbreakable {
                        material.strength = Some(0.5 * material.strength.unwrap_or(usual.strength));
                        material.toughness =
                            Some(0.5 * material.toughness.unwrap_or(usual.toughness));
                    }
                });
            }
            Self::Soap => {
                scene.material = materials(&|material: &mut MaterialText| {
                    let friction = material.friction.unwrap_or(usual.friction);
                    material.friction = Some(friction.min(0.02));
                });
                for obstacle in &mut scene.obstacle {
                    obstacle.friction = obstacle.friction.min(0.02);
                }
            }
            Self::Syrup => scene.drag += 2.0,
            Self::Mirror => return mirrored(&scene),
        }
        Some(scene)
    }
}
