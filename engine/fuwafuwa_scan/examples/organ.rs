//! Measures the time from the bytes of scans to a body.
//!
//! `cargo run --release -p fuwafuwa_scan --example organ -- 64 grey.nii.gz white.nii.gz`: probability maps of
//! two materials

use fuwafuwa::{Material, SoftBody};
use fuwafuwa_scan::{MAX_FILE_BYTES, Options, Organ, Scan, Segmentation};
use fuwafuwa_scenes::disk::read_bytes;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let resolution = words
        .next()
        .ok_or("name a resolution, such as 64")?
        .parse()?;
    let files: Vec<String> = words.collect();
    let bytes = files
        .iter()
        .map(|file| read_bytes(file.as_ref(), MAX_FILE_BYTES));
    let bytes = bytes.collect::<Result<Vec<_>, _>>()?;
    let options = Options {
        resolution,
        ..Options::default()
    };

    let start = Instant::now();
    let scans = files.iter().zip(&bytes);
    let scans = scans.map(|(file, bytes)| Scan::decode(file, bytes, |_| {}));
    let scans = scans.collect::<Result<Vec<_>, _>>()?;
    let read = start.elapsed();
    let scans: Vec<&Scan> = scans.iter().collect();
    let organ = Organ::of(&scans, &Segmentation::Maps, &options, |_| {})?;
    let made = start.elapsed();
    let [right, up, front] = organ.sides();
    println!(
        "{right:.0} x {up:.0} x {front:.0} mm, in a grid of {:?}",
        organ.grid.size()
    );
    for material in 1..=scans.len() as u8 {
        let voxels = organ.voxels(material);
        println!(
            "material {material}: {voxels} voxels, {:.0} ml",
            organ.millilitres(material)
        );
    }
    let body = SoftBody::new(organ.grid, &vec![Material::default(); scans.len()])?;
    let seconds = start.elapsed().as_secs_f32();
    println!(
        "read after {:.2} s, voxels after {:.2} s, {} elements after {seconds:.2} s",
        read.as_secs_f32(),
        made.as_secs_f32(),
        body.mesh().element_count()
    );
    Ok(())
}
