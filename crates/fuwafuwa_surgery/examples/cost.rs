//! scratch
use fuwafuwa::Rotation;
use fuwafuwa_surgery::{phantom, procedure::*, tools::*};
use std::{sync::Arc, time::Instant};
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let n: usize = std::env::args().nth(1).unwrap().parse()?;
    let t = Instant::now();
    let case = phantom::case(n)?;
    println!("case {:?}", t.elapsed());
    let mut p = Procedure::new(Arc::new(case))?;
    println!(
        "laid {:?} inertia {} elements {}",
        t.elapsed(),
        p.table().inertia,
        p.organ().mesh().element_count()
    );
    let mut worst = 0.0f64;
    let mut sum = 0.0;
    for tick in 0..240 {
        let s = tick as f32 / 60.0;
        let y = 0.09 - 0.03 * s.min(2.5);
        let input = Input {
            grips: true,
            ..Input::default().at(Tool::Hook, [0.01, y, 0.0], Rotation::NONE)
        };
        let t = Instant::now();
        let r = p.step(input)?;
        let ms = t.elapsed().as_secs_f64() * 1e3;
        if tick > 0 {
            worst = worst.max(ms);
            sum += ms;
        }
        if tick % 20 == 0 {
            println!(
                "{tick} {ms:.1} ms, {} substeps, force {:?} pieces {} rel {}",
                r.substeps,
                p.samples()[tick].force,
                p.samples()[tick].pieces,
                p.samples()[tick].released
            );
        }
    }
    println!("worst {worst:.1} mean {:.1}", sum / 239.0);
    Ok(())
}
