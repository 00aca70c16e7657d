//! Operations that each trick of a plan saves.

use rne_codegen::Function;
use rne_codegen::plan::{Cost, Descent, Plan, PlanSet, Rewritten, Trick};
use rne_model::Robot;

/// Returns the choices without some tricks. A rewritten graph belongs to a plan with all of its tricks, so it is
/// removed if the plan uses one of them.
#[must_use]
pub fn without(robot: &Robot, plans: &PlanSet, tricks: &[Trick]) -> PlanSet {
    let mut without = plans.clone();
    let plan = without_tricks(&mut Descent::new(robot, &[]), &plans.plan, tricks);
    without.plan = plan.unwrap_or_else(|| Plan::new(robot.joints.len()));
    let uses = |rewritten: &Rewritten, trick: &Trick| {
        *trick == Trick::Rewriting || rewritten.plan.as_ref().is_some_and(|plan| trick.is_in(plan))
    };
    without.rewritten.retain(|_, rewritten| !tricks.iter().any(|trick| uses(rewritten, trick)));
    without
}

/// Returns a plan without some tricks, and without choices that are impossible then: a unit that is a regrouped moment
/// is removed with the regrouping, an origin shift for carried prismatic links is removed with these.
fn without_tricks(costs: &mut Descent<'_>, plan: &Plan, tricks: &[Trick]) -> Option<Plan> {
    let rests = [Trick::Scales, Trick::OriginShifts, Trick::RegroupingTargets, Trick::LastFrame, Trick::Gyrostat];
    let mut plan = tricks.iter().fold(plan.clone(), |plan, trick| trick.left_out_of(&plan));
    for rest in rests {
        if costs.cost(&plan).is_some() {
            return Some(plan);
        }
        plan = rest.left_out_of(&plan);
    }
    costs.cost(&plan).is_some().then_some(plan)
}

/// Operations that each trick saves in `inverse_dynamics`: the code without the trick has this many more. The tricks of
/// a plan are counted before rewriting.
#[must_use]
pub fn savings(robot: &Robot, plans: &PlanSet) -> Vec<(Trick, isize)> {
    let plan = &plans.plan;
    let mut costs = Descent::new(robot, &[]);
    let Some(with) = costs.cost(plan) else { return Vec::new() };
    let more = |cost: &Cost| cost.total().cast_signed() - with.total().cast_signed();
    let used: Vec<Trick> = Trick::ALL.into_iter().filter(|trick| trick.is_in(plan)).collect();
    let saving = |trick: Trick| {
        let without = without_tricks(&mut costs, plan, &[trick])?;
        Some((trick, more(&costs.cost(&without)?)))
    };
    let mut savings: Vec<_> = used.into_iter().filter_map(saving).collect();
    let rewritten = plans.rewritten.get(&Function::InverseDynamics);
    savings.extend(rewritten.map(|rewritten| (Trick::Rewriting, -more(&rewritten.operations))));
    savings
}
