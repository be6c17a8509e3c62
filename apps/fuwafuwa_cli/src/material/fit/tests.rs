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
fn yeoh_fit_matches_scipy_for_treloar() {
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
    for (found, scipy) in constants.into_iter().zip([1.671e5, -1375.0, 40.87]) {
        assert!((found / scipy - 1.0).abs() < 2e-3, "{yeoh:?}");
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
        // A curve without a break gives no strength: the default of games would tear rubber at 1000 Pa.
        assert_eq!(found.strength, f32::INFINITY);
        assert_eq!(found.toughness, f32::INFINITY);
        assert!(text.contains("# density = "), "{text}");
    }
}

#[test]
fn errors_name_line_and_column() {
    for (text, wanted) in [
        ("", "a.csv: expected a header"),
        (
            "strain;stress_pa\n",
            "a.csv, line 1: expected a header with one column `strain` or `stretch`, found `strain;stress_pa`, separated by \
             semicolons",
        ),
        (
            "strain\tstress_pa\n",
            "a.csv, line 1: expected a header with one column `strain` or `stretch`, found `strain\tstress_pa`, separated by \
             tabs",
        ),
        (
            "# x\nextension,stress_pa\n",
            "a.csv, line 2: expected a header with one column `strain` or `stretch`, found `extension`, `stress_pa`",
        ),
        (
            "strain,stress\n",
            "a.csv, line 1: expected a header with one column `stress_pa` or `stress_kpa` or `stress_mpa`, found `strain`, \
             `stress`",
        ),
        (
            "strain,stress_pa,stress_kpa\n",
            "a.csv, line 1: expected a header with one column `stress_pa`",
        ),
        (
            "strain,stress_pa\n0,1,5,0\n",
            "a.csv, line 2: expected 2 columns separated by a comma, as in the header, found 4; decimals require a point",
        ),
        (
            "strain,stress_pa\n0.1;5\n",
            "a.csv, line 2: expected 2 columns separated by a comma, as in the header, found 1, separated by semicolons",
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

#[test]
fn curve_is_sorted_and_averaged() {
    let read = |text: &str| Curve::parse("a", text).unwrap();
    // A compression test in the order of the measurement.
    let pressed = read("strain,stress_pa\n0,0\n-0.125,-1\n-0.25,-2\n-0.375,-3\n-0.5,-4\n");
    let expected = [
        (0.5, -4.0),
        (0.625, -3.0),
        (0.75, -2.0),
        (0.875, -1.0),
        (1.0, 0.0),
    ];
    assert_eq!(pressed.points, expected);
    assert_eq!(pressed.notes, Vec::<String>::new());
    let twice = read("strain,stress_pa\n0.5,1\n1,2\n1,4\n1.5,5\n2,6\n");
    assert_eq!(
        twice.points,
        [(1.5, 1.0), (2.0, 3.0), (2.5, 5.0), (3.0, 6.0)]
    );
    let [note] = &twice.notes[..] else {
        panic!("{twice:?}")
    };
    assert!(note.contains("1 strains occur more than once"), "{note}");
    let back = read("strain,stress_pa\n0.5,1\n1,2\n1.5,5\n0.75,2\n");
    assert!(back.notes[0].contains("turns back 1 times"), "{back:?}");
    let other = read("time,stress_kpa,strain\n0,1,0.5\n1,2,1\n2,3,1.5\n3,4,2\n");
    assert_eq!(other.points[0], (1.5, 1000.0));
    assert_eq!(
        other.notes,
        ["of 3 columns, `strain` and `stress_kpa` are used"]
    );
}

#[test]
fn compression_has_the_constants_of_tension() {
    let stretches: Vec<f64> = (1..=30).map(|k| 1.0 - 0.02 * f64::from(k)).collect();
    let samples = of_energy([8e3, 0.0, 0.0], Mode::Uniaxial, &stretches);
    let text: String = { samples.iter() }
        .map(|one| format!("{},{}\n", one.stretch, one.stress))
        .collect();
    let curve = parse("a", &format!("stretch,stress_pa\n{text}")).unwrap();
    let fit = Fit::to(Law::NeoHookean, &after_slack(&curve, 0.0)).unwrap();
    assert!((fit.shear_modulus / 1.6e4 - 1.0).abs() < 1e-3, "{fit:?}");
}

#[test]
fn notes_name_likely_mistakes() {
    for (text, wanted) in [
        (
            "strain,stress_pa\n10,1\n20,2\n30,3\n50,5\n",
            "not a percentage",
        ),
        (
            "strain,stress_pa\n1,1\n1.1,2\n1.2,3\n1.3,4\n",
            "call it `stretch`",
        ),
        (
            "stretch,stress_pa\n0.05,1\n0.1,2\n0.2,3\n0.3,4\n",
            "call it `strain`",
        ),
    ] {
        let notes = Curve::parse("a", text).unwrap().notes;
        assert!(notes.iter().any(|note| note.contains(wanted)), "{notes:?}");
    }
    let law = |samples: &[Sample]| Fit::to(usual_law(samples), samples).unwrap();
    let good = of_energy([8e3, 80.0, 1.0], Mode::Uniaxial, &stretches(4.0));
    assert_eq!(doubts(&law(&good), &good, false), Vec::<String>::new());
    // Zeros after the break.
    let mut broken = good.clone();
    for stretch in [4.1, 4.2] {
        let stress = 0.0;
        broken.push(Sample {
            stretch,
            stress,
            ..good[0]
        });
    }
    let [doubt] = &doubts(&law(&broken), &broken, false)[..] else {
        panic!("one doubt")
    };
    assert!(doubt.contains("points after the break"), "{doubt}");
    let small = of_energy([8e3, 80.0, 1.0], Mode::Uniaxial, &stretches(1.05));
    assert_eq!(usual_law(&small), Law::NeoHookean);
    let yeoh = Fit::to(Law::Yeoh, &small).unwrap();
    assert!(doubts(&yeoh, &small, true)[0].contains("--law neo-hookean"));
    for factor in [1e-6, 1e6] {
        let wrong: Vec<Sample> = { good.iter() }
            .map(|one| Sample {
                stress: factor * one.stress,
                ..*one
            })
            .collect();
        assert!(doubts(&law(&wrong), &wrong, false)[0].contains("unit of the stress"));
    }
}

#[test]
fn standard_errors_match_scatter_of_repeated_fits() {
    let clean = of_energy([8e3, 80.0, 1.0], Mode::Uniaxial, &stretches(4.0));
    // Pseudo-random noise of 1 %, uniform, by a linear congruential generator.
    let mut state = 1_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        0.01 * 12f64.sqrt() * ((state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5)
    };
    let (mut found, mut errors) = (Vec::new(), Vec::new());
    for _ in 0..200 {
        let samples: Vec<Sample> = { clean.iter() }
            .map(|one| Sample {
                stress: one.stress * (1.0 + noise()),
                ..*one
            })
            .collect();
        let fit = Fit::to(Law::Yeoh, &samples).unwrap();
        found.push([fit.shear_modulus, fit.second, fit.third]);
        errors.push(fit.standard_errors(&samples).unwrap());
    }
    let mean = |all: &[[f64; 3]], k: usize| all.iter().map(|one| one[k]).sum::<f64>() / 200.0;
    for k in 0..3 {
        let middle = mean(&found, k);
        let squares: f64 = found.iter().map(|one| (one[k] - middle).powi(2)).sum();
        let scatter = (squares / 199.0).sqrt();
        let ratio = mean(&errors, k) / scatter;
        assert!((0.7..1.4).contains(&ratio), "constant {k}: {ratio}");
    }
}

#[test]
fn toe_is_left_out_independently_of_the_slack() {
    let curve: Vec<(f64, f64)> = [(1.01, 1.0), (1.015, 2.0), (1.03, 3.0), (1.5, 4.0)].to_vec();
    assert_eq!(samples_after(&curve, 0.0, true).len(), 2);
    assert_eq!(samples_after(&curve, 0.0, false).len(), 4);
    assert_eq!(after_slack(&curve, 0.0).len(), 4);
    assert_eq!(after_slack(&curve, 0.002).len(), 2);
}

/// Runs the command on a file with a curve of a neo-Hookean material, with further arguments.
fn run_on(name: &str, bytes: &[u8], more: &[&str]) -> Result<ExitCode> {
    use clap::Parser;
    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        arguments: Arguments,
    }
    let folder = std::env::temp_dir().join(format!("fuwafuwa-fit-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let path = folder.join("data.svg");
    std::fs::write(&path, bytes)?;
    let inside = more
        .iter()
        .map(|one| one.replace("FOLDER", folder.to_str().unwrap()));
    let all = ["fit".to_owned(), path.to_str().unwrap().to_owned()];
    let command = Command::try_parse_from(all.into_iter().chain(inside))?;
    let result = run(&command.arguments);
    assert_eq!(std::fs::read(&path)?, bytes, "the data are unchanged");
    std::fs::remove_dir_all(&folder)?;
    result
}

#[test]
fn plot_never_replaces_the_data() {
    let text = b"strain,stress_pa\n0.1,2500\n0.2,4700\n0.3,6700\n0.4,8600\n";
    let error = |more: &[&str]| run_on("plot", text, more).unwrap_err().to_string();
    assert!(error(&["--plot", "FOLDER/data.svg"]).contains("another file than the data"));
    assert!(error(&["--plot", "FOLDER/./data.svg"]).contains("another file than the data"));
    assert!(error(&["--plot", "FOLDER/a.png"]).contains("ends in .svg"));
    assert!(error(&["--plot", "FOLDER/data"]).contains("ends in .svg"));
    run_on("plot", text, &["--plot", "FOLDER/other.svg"]).unwrap();
}

#[test]
fn slack_of_compression_is_refused() {
    let text = b"strain,stress_pa\n0,0\n-0.1,-2500\n-0.2,-4700\n-0.3,-6700\n-0.4,-8600\n";
    for slack in ["auto", "0.01"] {
        let error = run_on("slack", text, &["--slack", slack]).unwrap_err();
        assert!(
            error.to_string().contains("--slack is for tensile curves"),
            "{error}"
        );
    }
    run_on("slack", text, &[]).unwrap();
}

#[test]
fn other_types_of_files_are_named() {
    for (bytes, wanted) in [
        (
            &b"\x89PNG\r\n\x1a\n...."[..],
            "expected a CSV text in UTF-8, found a PNG picture",
        ),
        (b"\xff\xfes\0t\0r\0a\0", "found a text in UTF-16"),
    ] {
        let error = run_on("type", bytes, &[]).unwrap_err().to_string();
        assert!(error.contains(wanted), "{error}");
    }
}
