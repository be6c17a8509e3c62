use super::*;
use fuwafuwa_scenes::Scene;

/// Stretches and stresses of a Yeoh law with the constants C₁, C₂ and C₃ [Pa], from the energy density by central
/// differences: independent of the formulas of the module.
fn of_energy(constants: [f64; 3], mode: Mode, stretches: &[f64]) -> Vec<Sample> {
    let energy = |stretch: f64| {
        let [x, y, z] = match mode {
            Mode::Uniaxial => [stretch, 1.0 / stretch.sqrt(), 1.0 / stretch.sqrt()],
            Mode::Equibiaxial => [stretch, stretch, 1.0 / (stretch * stretch)],
            Mode::PureShear => [stretch, 1.0, 1.0 / stretch],
        };
        let i = x * x + y * y + z * z - 3.0;
        constants[0] * i + constants[1] * i * i + constants[2] * i * i * i
    };
    // The energy of an equibiaxial test grows by the work along both axes.
    let axes = if mode == Mode::Equibiaxial { 2.0 } else { 1.0 };
    let stress = |at: f64| (energy(at + 1e-5) - energy(at - 1e-5)) / (2e-5 * axes);
    { stretches.iter() }
        .map(|&stretch| Sample {
            mode,
            stretch,
            stress: stress(stretch),
        })
        .collect()
}

fn stretches(most: f64) -> Vec<f64> {
    (1..=40)
        .map(|k| 1.0 + (most - 1.0) * f64::from(k) / 40.0)
        .collect()
}

#[test]
fn fit_recovers_constants_of_synthetic_curves() {
    for (constants, most) in [
        ([8e3, 80.0, 1.0], 4.0),
        ([1.67e5, -1375.0, 40.9], 7.0),
        // The largest strain is below the one at which g stops growing.
        ([1.1e4, 220.0, -1.5], 4.0),
        ([8e3, 0.0, 0.0], 3.0),
    ] {
        for mode in Mode::ALL {
            let most = if mode == Mode::Equibiaxial { 3.0 } else { most };
            let mut samples = of_energy(constants, mode, &stretches(most));
            let fit = Fit::to(Law::Yeoh, &samples).unwrap();
            let [c1, c2, c3] = constants;
            let wanted = [2.0 * c1, c2 / c1, c3 / c1];
            let found = [fit.shear_modulus, fit.second, fit.third];
            for ((found, wanted), scale) in
                found.into_iter().zip(wanted).zip([2.0 * c1, 0.01, 1e-4])
            {
                let error = (found - wanted).abs();
                assert!(
                    error < 0.02 * wanted.abs() + 0.02 * scale,
                    "{constants:?} {mode:?} {fit:?}"
                );
            }
            // Noise of 1 % with a mean of 0.
            for (index, sample) in samples.iter_mut().enumerate() {
                sample.stress *= 1.0 + 0.01 * [1.0, -1.0, -1.0, 1.0][index % 4];
            }
            let noisy = Fit::to(Law::Yeoh, &samples).unwrap();
            assert!(
                (noisy.shear_modulus / wanted[0] - 1.0).abs() < 0.02,
                "{noisy:?}"
            );
            let deviations = noisy.deviations(&samples);
            assert!(deviations.relative < 0.0105, "{deviations:?}");
        }
    }
}

#[test]
fn stress_of_fit_grows_with_stretch() {
    // Stresses that fall in the middle, and ones that level off.
    let falling = [1.0, 2.0, 2.5, 2.2, 1.5, 1.2, 2.0, 4.0, 9.0];
    let level = [1.0, 2.0, 2.5, 2.6, 2.6, 2.6, 2.6, 2.6, 2.6];
    for stresses in [falling, level] {
        let samples: Vec<Sample> = { stresses.iter().enumerate() }
            .map(|(k, stress)| Sample {
                mode: Mode::Uniaxial,
                stretch: 1.2 + 0.4 * k as f64,
                stress: 1e4 * stress,
            })
            .collect();
        let fit = Fit::to(Law::Yeoh, &samples).unwrap();
        fit.material(0.49).check().unwrap();
        for k in 0..400 {
            let stretch = 0.125 + 0.02 * f64::from(k);
            let [low, high] = [stretch, stretch + 0.02].map(|at| fit.stress(Mode::Uniaxial, at));
            assert!(high > low, "{fit:?} {stretch}");
        }
    }
}

const TRELOAR: &str = include_str!("../../experiment/data/treloar_uniaxial.csv");

#[test]
fn treloar_has_the_published_constants() {
    // Least squares with scipy, with the same weights: μ of the neo-Hookean law, and C₁, C₂ and C₃ of Yeoh's.
    let curve = parse("treloar", TRELOAR).unwrap();
    let samples = after_slack(&curve, 0.0);
    let neo_hookean = Fit::to(Law::NeoHookean, &samples).unwrap();
    assert!(
        (neo_hookean.shear_modulus / 3.954e5 - 1.0).abs() < 1e-3,
        "{neo_hookean:?}"
    );
    let yeoh = Fit::to(Law::Yeoh, &samples).unwrap();
    let constants =
        [0.5, 0.5 * yeoh.second, 0.5 * yeoh.third].map(|share| share * yeoh.shear_modulus);
    for (found, published) in constants.into_iter().zip([1.671e5, -1375.0, 40.87]) {
        assert!((found / published - 1.0).abs() < 2e-3, "{yeoh:?}");
    }
    // At small and moderate strains, Treloar's own value is 0.39 MPa.
    let small: Vec<Sample> = samples
        .into_iter()
        .filter(|one| one.stretch < 1.5)
        .collect();
    let fit = Fit::to(Law::NeoHookean, &small).unwrap();
    assert!((fit.shear_modulus / 3.9e5 - 1.0).abs() < 0.06, "{fit:?}");
}

#[test]
fn slack_is_found() {
    let samples = of_energy([8e3, 80.0, 1.0], Mode::Uniaxial, &stretches(3.0));
    let curve: Vec<(f64, f64)> = { samples.iter() }
        .map(|one| (one.stretch + 0.03, one.stress))
        .collect();
    assert!((find_slack(&curve).unwrap() - 0.03).abs() < 0.0015);
}

#[test]
fn scene_reads_the_material() {
    let curve = parse("treloar", TRELOAR).unwrap();
    for law in [Law::NeoHookean, Law::Yeoh] {
        let fit = Fit::to(law, &after_slack(&curve, 0.0)).unwrap();
        let text = format!(
            "dim = 3\n{}[[body]]\nshape = \"ball\"\nn = 4\n",
            fit.toml(0.45)
        );
        let scene = Scene::read("rubber.toml", &text, &[]).unwrap();
        let [found] = scene.materials()[..] else {
            panic!("one material")
        };
        let wanted = fit.material(0.45);
        assert_eq!(found.elasticity, wanted.elasticity);
        assert_eq!(found.stress_law, wanted.stress_law);
    }
}

#[test]
fn errors_name_line_and_column() {
    for (text, wanted) in [
        ("", "a.csv: expected a header"),
        (
            "strain;stress_pa\n",
            "a.csv, line 1: expected 2 columns separated by a comma, found 1",
        ),
        (
            "# x\nextension,stress_pa\n",
            "a.csv, line 2, column 1: expected the header `strain` or `stretch`, found `extension`",
        ),
        (
            "strain,stress\n",
            "a.csv, line 1, column 2: expected the header `stress_pa`, `stress_kpa` or `stress_mpa`, found `stress`",
        ),
        (
            "strain,stress_pa\n0.1,x\n",
            "a.csv, line 2, column 2: expected a finite number, found `x`",
        ),
        (
            "strain,stress_pa\nnan,1\n",
            "a.csv, line 2, column 1: expected a finite number, found `nan`",
        ),
        (
            "strain,stress_pa\n0.2,1\n\n0.1,2\n",
            "a.csv, line 4, column 1: expected a number above 0.2",
        ),
        (
            "stretch,stress_pa\n-0.2,1\n",
            "a.csv, line 2, column 1: expected a stretch above 0, found -0.2",
        ),
        (
            "strain,stress_pa\n0,0\n0.1,1\n0.2,2\n0.3,3\n",
            "a.csv: expected at least 4 points with a stress other than 0, found 3",
        ),
    ] {
        let error = parse("a.csv", text).unwrap_err().to_string();
        assert!(error.starts_with(wanted), "{error}");
    }
    let units =
        |header: &str| parse("a", &format!("{header}\n1.1,1\n1.2,2\n1.3,3\n1.4,4\n")).unwrap()[0];
    assert_eq!(units("stretch,stress_mpa"), (1.1, 1e6));
    assert_eq!(units("strain,stress_kpa"), (2.1, 1e3));
}

#[test]
fn stresses_of_the_wrong_sign_are_an_error() {
    let samples = [1.1, 1.2, 1.3, 1.4].map(|stretch| Sample {
        mode: Mode::Uniaxial,
        stretch,
        stress: -1e3 * stretch,
    });
    for law in [Law::NeoHookean, Law::Yeoh] {
        assert!(Fit::to(law, &samples).is_err());
    }
}
