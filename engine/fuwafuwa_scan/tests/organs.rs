//! Shape and materials of organs from scans.

mod phantom;

use fuwafuwa::{Dim3, VoxelGrid};
use fuwafuwa_scan::{Options, Organ, OrganError, Scan, Segmentation};
use fuwafuwa_scenes::import::{Model, vox};
use phantom::{File, RAS, ball, organ};

fn distance(patient: [f64; 3], middle: [f64; 3]) -> f64 {
    let squares = (0..3).map(|axis| (patient[axis] - middle[axis]).powi(2));
    squares.sum::<f64>().sqrt()
}

/// Returns a value that falls from 1 to 0 over `across` [mm] around a border, like the blur of a scanner.
/// `inside` is the depth behind the border [mm].
fn smeared(inside: f64, across: f64) -> f64 {
    (0.5 + inside / across).clamp(0.0, 1.0)
}

fn near(found: f64, expected: f64, tolerance: f64) {
    let good = (found - expected).abs() <= tolerance * expected;
    assert!(good, "expected {expected}, found {found}");
}

#[test]
fn thresholds_preserve_volume_at_each_resolution() {
    let file = File::of(RAS, [1.5, 1.5, 3.0], |patient| {
        1000.0 * smeared(30.0 - distance(patient, [0.0; 3]), 3.0)
    });
    let tissue = Segmentation::thresholds(&[(500.0..=f32::INFINITY, 7)]);
    for resolution in [16, 32, 64, 100] {
        let organ = organ(&file.scan(), &tissue, resolution);
        near(organ.millilitres(7), ball(30.0), 0.03);
        assert_eq!(organ.grid.solid_count(), organ.voxels(7));
        let longest = organ.grid.size().into_iter().max();
        assert_eq!(longest, Some(resolution as i32));
    }
}

#[test]
fn maps_choose_most_probable_material_without_gaps() {
    let depth = |patient| 30.0 - distance(patient, [0.0; 3]);
    // One probability map has bytes up to 255, and the other has fractions up to 1.
    let grey = File::of(RAS, [2.0; 3], |patient| {
        let inside = smeared(depth(patient), 4.0);
        255.0 * inside * (1.0 - smeared(depth(patient) - 12.0, 4.0))
    });
    let mut white = File::of(RAS, [1.5; 3], |patient| smeared(depth(patient) - 12.0, 4.0));
    white.datatype = 16;
    let (grey, white) = (grey.scan(), white.scan());
    let organ = Organ::of(
        &[&grey, &white],
        &Segmentation::Maps,
        &Options::default(),
        |_| {},
    );
    let organ = organ.unwrap();
    near(organ.millilitres(2), ball(18.0), 0.03);
    near(organ.millilitres(1), ball(30.0) - ball(18.0), 0.03);
    let options = Options {
        fills_holes: true,
        ..Options::default()
    };
    let filled = Organ::of(&[&grey, &white], &Segmentation::Maps, &options, |_| {}).unwrap();
    assert_eq!(filled.grid, organ.grid, "there must be no gap to fill");
}

#[test]
fn organ_ignores_distant_specks() {
    let sound = |patient| 20.0 - distance(patient, [-20.0, 10.0, 0.0]);
    let speck = |patient| 4.0 - distance(patient, [50.0, -45.0, 40.0]);
    let alone = File::of(RAS, [2.0; 3], |patient| {
        100.0 * smeared(sound(patient), 3.0)
    });
    let both = File::of(RAS, [2.0; 3], |patient| {
        100.0 * smeared(sound(patient).max(speck(patient)), 3.0)
    });
    let tissue = Segmentation::thresholds(&[(50.0..=100.0, 1)]);
    let [alone, both] = [alone, both].map(|file| organ(&file.scan(), &tissue, 32));
    assert_eq!(alone.grid, both.grid);
    near(alone.sides()[0], 40.0, 0.06);
}

#[test]
fn organ_fills_holes_on_request() {
    let file = File::of(RAS, [2.0; 3], |patient| {
        let far = distance(patient, [0.0; 3]);
        f64::from(u8::from(far < 30.0 && far > 12.0))
    });
    let labels = Segmentation::labels(&[(1, 3)]);
    let options = |fills_holes| Options {
        resolution: 40,
        fills_holes,
    };
    let made = |options: Options| Organ::of(&[&file.scan()], &labels, &options, |_| {}).unwrap();
    let (hollow, full) = (made(options(false)), made(options(true)));
    near(hollow.millilitres(3), ball(30.0) - ball(12.0), 0.03);
    near(full.millilitres(3), ball(30.0), 0.03);
}

#[test]
fn organ_round_trips_through_vox_model() {
    let file = File::of(RAS, [2.0; 3], |patient| f64::from(phantom::label(patient)));
    let organ = organ(&file.scan(), &phantom::labels(), 24);
    let model = Model::of("a.vox", &organ.grid, &[[200, 90, 80]]).unwrap();
    let back = vox("a.vox", &model.bytes(), organ.grid.voxel_size()).unwrap();
    // The model has no empty layers around the organ.
    assert_eq!(solid(&back.grid), solid(&organ.grid));
    assert!(back.notes.is_empty());
}

/// Returns the solid voxels, counted from the low corner of the box around them, and their materials.
fn solid(grid: &VoxelGrid<Dim3>) -> Vec<([i32; 3], u8)> {
    let voxels = grid.voxels().filter(|&voxel| grid.is_solid(voxel));
    let voxels: Vec<_> = voxels.collect();
    let low = [0, 1, 2].map(|axis| voxels.iter().map(|voxel| voxel[axis]).min().unwrap());
    let from_low = |voxel: [i32; 3]| [0, 1, 2].map(|axis| voxel[axis] - low[axis]);
    let materials = voxels.iter();
    materials
        .map(|&voxel| (from_low(voxel), grid.material(voxel)))
        .collect()
}

#[test]
fn organ_rejects_invalid_options() {
    let scan = File::small([2, 2, 2], &[1.0; 8]).scan();
    let labels = Segmentation::labels(&[(1, 1)]);
    let refused = |scans: &[&Scan], segmentation: &Segmentation, resolution| {
        let options = Options {
            resolution,
            ..Options::default()
        };
        let outcome = Organ::of(scans, segmentation, &options, |_| {});
        outcome
            .expect_err("the options must be rejected")
            .to_string()
    };
    let error = refused(&[&scan], &labels, 7);
    assert_eq!(
        error,
        "expected 8..=256 voxels along the longest side, found 7"
    );
    let error = refused(&[&scan, &scan], &labels, 8);
    assert_eq!(
        error,
        "expected one scan with intensities or labels, found 2"
    );
    let error = refused(&[], &Segmentation::Maps, 8);
    assert_eq!(
        error,
        "expected 1 to 255 scans, a map for each material, found 0"
    );
    let empty = Segmentation::labels(&[(2, 1)]);
    let outcome = Organ::of(&[&scan], &empty, &Options::default(), |_| {});
    assert_eq!(outcome.err(), Some(OrganError::Empty));
}

#[test]
fn progress_increases_from_zero_to_one() {
    let file = File::of(RAS, [2.0; 3], |patient| f64::from(phantom::label(patient)));
    let mut told = Vec::new();
    let scan = Scan::decode("a.nii", &file.bytes(), |done| told.push(done)).unwrap();
    let check = |told: &[f32]| {
        assert_eq!((told.first(), told.last()), (Some(&0.0), Some(&1.0)));
        assert!(told.is_sorted(), "{told:?}");
        assert!(told.len() > 2);
    };
    check(&told);
    told.clear();
    let options = Options::default();
    Organ::of(&[&scan], &phantom::labels(), &options, |done| {
        told.push(done)
    })
    .unwrap();
    check(&told);
}
