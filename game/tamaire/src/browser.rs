//! The way in through a browser: the page hands over a canvas and itself, and says when it goes away.

mod labels;

use crate::app::App;
use crate::game::Game;
use crate::platform::{Files, Host, Pads, Sound, set_host};
use eframe::{WebOptions, WebRunner};
use labels::Labels;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

/// The game on a canvas.
#[wasm_bindgen]
pub struct Running {
    runner: WebRunner,
    context: egui::Context,
    labels: Labels,
}

#[wasm_bindgen]
impl Running {
    /// Begins, and goes on until [`Running::end`].
    ///
    /// # Errors
    /// Why there is nothing to draw with.
    pub async fn start(canvas: HtmlCanvasElement, host: Host) -> Result<Running, JsValue> {
        set_host(host);
        let (runner, labels) = (WebRunner::new(), Labels::default());
        let kept = std::rc::Rc::new(std::cell::OnceCell::new());
        let (known, plugin) = (kept.clone(), labels.clone());
        let create = move |context: &eframe::CreationContext<'_>| {
            context.egui_ctx.add_plugin(plugin);
            // It is made once.
            let _ = known.set(context.egui_ctx.clone());
            let game = Game::new(Files::usual(), Sound::open(), Pads::open());
            Ok(Box::new(App::new(context, game)?) as Box<dyn eframe::App>)
        };
        runner
            .start(canvas, WebOptions::default(), Box::new(create))
            .await?;
        let context = kept.get().cloned().unwrap_or_default();
        Ok(Self {
            runner,
            context,
            labels,
        })
    }

    /// How things stand, for whoever looks on: a test, or an exhibit.
    pub fn report(&self) -> Option<Report> {
        // From the next frame on what stands there has names.
        self.context.enable_accesskit();
        let app = self.runner.app_mut::<App>()?;
        let (game, round, seen) = (&app.game, app.game.bout.round(), self.labels.seen());
        let [hand, origin, right] = match game.bout.view {
            None => [[f32::NAN; 2]; 3],
            Some(view) => {
                let at = |place| <[f32; 2]>::from(view.on_screen(place) * app.zoom);
                [
                    at(round.hands()[0].position()),
                    at([0.0; 3]),
                    at([1.0, 0.0, 0.0]),
                ]
            }
        };
        Some(Report {
            screen: format!("{:?}", game.screen()),
            level: round.level().id.clone(),
            language: format!("{:?}", game.settings.language),
            ticks: round.ticks() as u32,
            is_won: round.progress().outcome.is_some(),
            won: { game.levels.iter() }
                .filter(|level| {
                    game.records
                        .of(&level.id)
                        .is_some_and(|record| !record.best.is_empty())
                })
                .map(|level| level.id.clone())
                .collect(),
            labels: { seen.iter() }
                .map(|(name, rect)| {
                    let at = rect.center() * app.zoom;
                    format!("{} {} {name}", at.x, at.y)
                })
                .collect(),
            notices: game
                .notices
                .iter()
                .map(|notice| notice.text.clone())
                .collect(),
            memory: (core::arch::wasm32::memory_size(0) << 16) as u32,
            hand: hand.into(),
            origin: origin.into(),
            right: right.into(),
        })
    }

    /// Writes what is still to be written: the page may not come back.
    pub fn flush(&self) {
        if let Some(mut app) = self.runner.app_mut::<App>() {
            app.game.finish_writing();
        }
    }

    /// Ends it because its GPU is lost. The round may be watched later.
    pub fn end(&self) {
        if let Some(mut app) = self.runner.app_mut::<App>() {
            app.game.rescue();
        }
        self.runner.destroy();
    }
}

/// How things stand. Places are in the pixels of the page.
#[wasm_bindgen(getter_with_clone)]
pub struct Report {
    /// What is seen.
    pub screen: String,
    /// The level of the round that is on.
    pub level: String,
    /// What the game speaks.
    pub language: String,
    /// How long the round has been going on [1/60 s].
    pub ticks: u32,
    /// Whether it is won.
    pub is_won: bool,
    /// The levels in which there is a record.
    pub won: Vec<String>,
    /// What can be pressed: where, and its name.
    pub labels: Vec<String>,
    /// What the player is being told.
    pub notices: Vec<String>,
    /// How much memory the game has taken [bytes].
    pub memory: u32,
    /// Where the first hand is.
    pub hand: Vec<f32>,
    /// Where the middle of the world is.
    pub origin: Vec<f32>,
    /// And a place 1 m to the right of it.
    pub right: Vec<f32>,
}
