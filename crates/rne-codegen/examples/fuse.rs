use rne_codegen::{*, reduced::*};
use rne_model::Robot;
use std::collections::*;
fn names(e:&Expression,out:&mut BTreeSet<Name>){use Expression::*;match e{Variable(n)=>{out.insert(*n);},Zero=>{},Negative(a)=>names(a,out),Sum(a,b)|Difference(a,b)|Product(a,b)=>{names(a,out);names(b,out)}}}
fn main() {
    for path in std::env::args().skip(1) {
        let robot = Robot::from_yaml(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let p = path.replace(".yaml", ".plan.yaml");
        let choice: Choice = PlanFile::read(&p, &std::fs::read_to_string(&p).unwrap(), &robot).unwrap().into();
        for form in [Form::Reduced] {
        let Ok(program) = choice.compile(&robot, Function::InverseDynamics, form) else { continue };
        let program = fusion::fused(&program);
        let total = fusion::instructions(&program);
        let mut best=vec![];
        let mut done=0;
        for k in 0..program.statements.len(){
            let one = Program{statements: vec![program.statements[k].clone()], outputs: vec![], ..program.clone()};
            done += fusion::instructions(&one);
            let defined: BTreeSet<_> = program.statements[..=k].iter().map(|s|s.name).collect();
            let mut used=BTreeSet::new();
            for s in &program.statements[k+1..]{names(&s.value,&mut used);} for o in &program.outputs{names(&o.value,&mut used);}
            let live=used.intersection(&defined).count();
            best.push((done,live));
        }
        print!("{path} {total}:");
        for (d,l) in best.iter().step_by(best.len()/24+1){print!(" {d}:{l}");}
        println!();
        }
    }
}
