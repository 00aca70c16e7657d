use rne_codegen::{*, reduced::*};
use rne_model::Robot;
fn main() {
    for path in std::env::args().skip(1) {
        let robot = Robot::from_yaml(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let p = path.replace(".yaml", ".plan.yaml");
        let choice: Choice = PlanFile::read(&p, &std::fs::read_to_string(&p).unwrap(), &robot).unwrap().into();
        for form in [Form::SevenSteps, Form::Reduced, Form::Rewritten] {
        let Ok(program) = choice.compile(&robot, Function::InverseDynamics, form) else { continue };
        let o = program.operations();
        println!("{path} {form} {} = {}+{}; {} -> {}", o.total(), o.mul, o.add, fusion::instructions(&program), fusion::instructions(&fusion::fused(&program)));
        }
    }
}
