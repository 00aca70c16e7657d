//! The names of the numbers in generated code.

use rne_codegen::{Axis, Name, Quantity};

#[test]
fn names_are_the_interface() {
    use Axis::{X, Y, Z};
    for (name, text) in [
        (Name::vector(Quantity::Omega, 2, Z), "w2_z"),
        (Name::vector(Quantity::OmegaDot, 2, X), "dw2_x"),
        (Name::vector(Quantity::Velocity, 2, Y), "dc2_y"),
        (Name::vector(Quantity::Acceleration, 2, Y), "ddc2_y"),
        (Name::vector(Quantity::Gravity, 2, Z), "g2_z"),
        (Name::vector(Quantity::InertiaForce, 2, X), "f2_x"),
        (Name::vector(Quantity::InertiaMoment, 2, X), "n2_x"),
        (Name::vector(Quantity::JointForce, 2, X), "f1_2_x"),
        (Name::vector(Quantity::JointMoment, 2, X), "n1_2_x"),
        (Name::scalar(Quantity::Torque, 2), "tau2"),
        (Name::scalar(Quantity::Sine, 2), "s2"),
        (Name::scalar(Quantity::Cosine, 2), "c2"),
        (Name::matrix(Quantity::Rotation, 3, X, Y), "rot3_xy"),
        (Name { part: 1, ..Name::vector(Quantity::Acceleration, 3, X) }, "ddc3_x_1"),
    ] {
        assert_eq!(name.to_string(), text);
    }
}

#[test]
fn an_index_is_no_number_of_a_shared_term() {
    let element = Name::indexed(Quantity::ScaledFactor, 5, 2);
    let shared = Name { part: 2, ..Name::scalar(Quantity::ScaledFactor, 5) };
    assert_ne!(element, shared);
    assert_eq!(element.to_string(), shared.to_string(), "why texts are compared, not names");
    assert_eq!(Name { part: 1, ..element }.to_string(), "lowd5_2_1");
    assert_eq!(Name::indexed(Quantity::GroupSine, 4, 2).to_string(), "s2_4");
    let parameter = Name { indices: [3, 10], ..Name::scalar(Quantity::RegressorElement, 2) };
    assert_eq!(parameter.to_string(), "y2_3_10");
}
