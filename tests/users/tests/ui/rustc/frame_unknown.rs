use rne::FrameKinematics;

#[derive(FrameKinematics)]
#[robot(path = "../robots/two.yaml")]
struct Two;

fn main() {
    let q = [0.1, 0.2];
    let jacobian = Two.jacobian_of::<{ Two::frame("join1") }, _>(&q);
    println!("{jacobian:?}");
}
