use rne::{ClosedLoops, FloatingClosedLoops};

#[derive(ClosedLoops, FloatingClosedLoops)]
#[robot(path = "robots/lop.yaml")]
struct Linkage;

fn main() {
    let closed = Linkage.close(&[0.6], &[1.3, -0.7]);
    let map = Linkage.loop_map(&[0.6], &closed.passive);
    println!("{} {map:?} {:?}", Linkage::NAME, closed.residual);
}
