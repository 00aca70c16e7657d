//! Tensors of thin rods and thin plates, whose moments lie on the border of what a body can have, as files print them:
//! rounded to some digits.

use rne_model::{Reader, Severity};

use crate::common::{BASE, with};

/// Numbers from 0 to 1, the same in each run.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let number = (state >> 11) as f64 / (1_u64 << 53) as f64;
        number
    }
}

/// The tensor of a rod, or of a plate, along a random direction u: I (1 - u uᵀ), or I (1 + u uᵀ).
pub(crate) fn thin(random: &mut impl FnMut() -> f64, sign: f64) -> [f64; 6] {
    let u = loop {
        let u = [0; 3].map(|_| 2.0 * random() - 1.0);
        let length = u.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (0.1..1.0).contains(&length) {
            break u.map(|x| x / length);
        }
    };
    let size = 10.0_f64.powf(-3.0 * random());
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
        .map(|(i, j)| size * (f64::from(u8::from(i == j)) + sign * u[i] * u[j]))
}

/// An element with so many significant digits, or so many decimals of the size of the tensor.
// small numbers of digits
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
fn printed(elements: [f64; 6], digits: usize, fixed: bool) -> [String; 6] {
    let largest = elements.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let decimals = (digits as f64 - 1.0 - largest.log10().floor()) as usize;
    elements.map(|x| if fixed { format!("{x:.decimals$}") } else { format!("{x:.0$e}", digits - 1) })
}

#[test]
fn rounded_rods_and_plates_are_bodies() {
    let mut random = random(7);
    for index in 0..300 {
        let sign = if index % 3 == 0 { 1.0 } else { -1.0 };
        let [xx, yy, zz, xy, xz, yz] = printed(thin(&mut random, sign), 3 + index % 4, index % 2 == 0);
        let tensor = format!("{{xx: {xx}, yy: {yy}, zz: {zz}, xy: {xy}, xz: {xz}, yz: {yz}}}");
        let text = with("{xx: 0.1, yy: 0.12, zz: 0.02}", &tensor);
        let read = Reader::new("rod.yaml").read(&text).unwrap_or_else(|report| panic!("{index}: {report}"));
        assert_eq!(read.lints.warnings().count(), 0, "{index}: {}", read.lints);
        if sign > 0.0 {
            continue;
        }
        // what rounding does not explain is no body
        let off = text.replace(&format!("xx: {xx}"), &format!("xx: {xx} - 0.1*({yy} + {zz})"));
        let refused = match Reader::new("rod.yaml").read(&off) {
            Ok(read) => read.lints.diagnostics.iter().any(|lint| lint.severity == Severity::Warning),
            Err(report) => report.short().contains("no body can have this inertia"),
        };
        assert!(refused, "{index}: {off}");
    }
}

/// About the origin of the frame, mass and centre of mass are rounded, too.
#[test]
fn rounded_rods_about_the_origin_are_bodies() {
    let mut random = random(8);
    for index in 0..100 {
        let own = thin(&mut random, -1.0);
        let (m, c) = (1.0 + random(), [0; 3].map(|_| random() - 0.5));
        let square = c.iter().map(|x| x * x).sum::<f64>();
        let places = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        let mut about = own;
        for (element, (i, j)) in about.iter_mut().zip(places) {
            *element += m * (f64::from(u8::from(i == j)) * square - c[i] * c[j]);
        }
        let [xx, yy, zz, xy, xz, yz] = about.map(|x| format!("{x:.5}"));
        let [x, y, z] = c.map(|x| format!("{x:.5}"));
        let text = BASE
            .replace(
                "inertia: {xx: 0.1, yy: 0.12, zz: 0.02}",
                &format!("inertia: {{xx: {xx}, yy: {yy}, zz: {zz}, xy: {xy}, xz: {xz}, yz: {yz}}}"),
            )
            .replace("mass: 2.5", &format!("mass: {m:.5}"))
            .replace("com: [0, 0, 0.3]", &format!("com: [{x}, {y}, {z}]"))
            .replace("inertia_about: com", "inertia_about: origin");
        assert_ne!(text, BASE);
        let read = Reader::new("rod.yaml").read(&text).unwrap_or_else(|report| panic!("{index}: {report}"));
        assert_eq!(read.lints.warnings().count(), 0, "{index}: {}", read.lints);
    }
}
