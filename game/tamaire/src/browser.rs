//! Entry point in a browser. The page passes a canvas and a host object, and calls [`Running::flush`] when
//! the page is hidden.

mod labels;

use crate::app::App;
use crate::game::Game;
use crate::platform::{Files, Host, Sound, set_host, today};
use app_shell::Pads;
use eframe::{WebOptions, WebRunner};
use fuwafuwa::Vec3;
use labels::Labels;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

/// The game running on a canvas.
#[wasm_bindgen]
pub struct Running {
    runner: WebRunner,
    context: egui::Context,
    labels: Labels,
}

#[wasm_bindgen]
impl Running {
    /// Starts the game, which runs until [`Running::end`].
    ///
    /// # Errors
    /// If there is no graphics adapter.
    pub async fn start(canvas: HtmlCanvasElement, host: Host) -> Result<Running, JsValue> {
        set_host(host);
        let (runner, labels) = (WebRunner::new(), Labels::default());
        let kept = std::rc::Rc::new(std::cell::OnceCell::new());
        let (known, plugin) = (kept.clone(), labels.clone());
        let create = move |context: &eframe::CreationContext<'_>| {
            context.egui_ctx.add_plugin(plugin);
            // The closure runs only once, so the cell is still empty and setting it cannot fail.
            let _ = known.set(context.egui_ctx.clone());
            let mut game = Game::new(Files::usual(), Sound::open(), Pads::open());
            game.calendar = Some(today);
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

    /// Returns the state of the game, for tests and for exhibits in a browser.
    pub fn report(&self) -> Option<Report> {
        // Turns on egui's accessibility tree, from which the labels of widgets are read. The labels are
        // available from the next frame on.
        self.context.enable_accesskit();
        let app = self.runner.app_mut::<App>()?;
        let (game, round, seen) = (&app.game, app.game.bout.round(), self.labels.seen());
        let [hand, origin, right] = match game.bout.view {
            None => [[f32::NAN; 2]; 3],
            Some(view) => {
                let at = |place| <[f32; 2]>::from(view.to_screen(place) * app.zoom);
                [at(round.hands()[0].position), at(Vec3::ZERO), at(Vec3::X)]
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
                        .of_level(level)
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

    /// Keeps the level in the editor and writes pending data. Called when the page is hidden, because a hidden page may be closed without
    /// notice.
    pub fn flush(&self) {
        if let Some(mut app) = self.runner.app_mut::<App>() {
            app.game.flush();
        }
    }

    /// Ends the game. Called when its GPU was lost. A round in progress is saved as a replay.
    pub fn end(&self) {
        if let Some(mut app) = self.runner.app_mut::<App>() {
            app.game.rescue();
        }
        self.runner.destroy();
    }
}

/// State of the game. Positions are in pixels of the page.
#[wasm_bindgen(getter_with_clone)]
pub struct Report {
    /// Current screen.
    pub screen: String,
    /// Level of the current round.
    pub level: String,
    /// Language of the game.
    pub language: String,
    /// Length of the round up to now [1/60 s].
    pub ticks: u32,
    /// Whether the round is won.
    pub is_won: bool,
    /// Ids of the levels that the player has won.
    pub won: Vec<String>,
    /// Labelled widgets, each as "x y name" with the position of its centre.
    pub labels: Vec<String>,
    /// Messages shown to the player.
    pub notices: Vec<String>,
    /// Memory of the game [bytes].
    pub memory: u32,
    /// Position of the first hand [px].
    pub hand: Vec<f32>,
    /// Position of the world origin on the page [px].
    pub origin: Vec<f32>,
    /// Position on the page of the world point 1 m to the right of the origin [px].
    pub right: Vec<f32>,
}
