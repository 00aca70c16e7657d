//! Decides when each value is computed and where it is kept.

use std::collections::HashMap;

use rne_codegen::{Value, ValueId};
use rne_runtime::machine::{Code, Instruction, NOWHERE, Operation, Slot, Turn};

use crate::dataflow::Dataflow;
use crate::selection::{Place, constants, operation};

/// One action of the generated code; a list of them is in the order of execution.
#[derive(Clone, Copy, Debug)]
enum Event {
    /// Computes a value, or loads an input or a constant, into the accumulator.
    Compute(ValueId),
    /// Writes the value in the accumulator to the output at this index.
    Output(usize),
    /// Computes all sines and cosines.
    Turns,
}

/// Returns the code of a program; `None` if it needs too many slots.
pub(crate) fn code(dataflow: &Dataflow) -> Option<Code> {
    // constants that are part of an instruction need no slot
    let carried: Vec<Vec<ValueId>> = dataflow.values.iter().map(|(id, _)| constants(dataflow, id)).collect();
    let events = events(dataflow, &carried);
    allocated(dataflow, &carried, &events)
}

/// Returns the events in the order of the program. An input or constant is loaded just before its first use, but not
/// between a value and the next one that takes it from the accumulator.
fn events(dataflow: &Dataflow, carried: &[Vec<ValueId>]) -> Vec<Event> {
    let is_live = dataflow.live();
    let mut outputs: HashMap<ValueId, Vec<usize>> = HashMap::new();
    for (index, output) in dataflow.outputs.iter().enumerate() {
        outputs.entry(*output).or_default().push(index);
    }
    let is_computed = |id: &ValueId| is_live[id.index()] && dataflow.is_computed(*id);
    let ids: Vec<ValueId> = dataflow.values.iter().map(|(id, _)| id).collect();
    let (before_turns, beyond_turns) = ids.split_at(dataflow.before_turns);
    let mut fetched = vec![false; ids.len()];
    let mut events = Vec::new();
    let mut part = |values: &[ValueId], last: &[ValueId], events: &mut Vec<Event>| {
        let mut chain = events.len();
        let mut before = None;
        for value in values.iter().copied().filter(is_computed) {
            let operands = dataflow.operands(value);
            if before.is_none_or(|before| !operands.contains(&before)) {
                chain = events.len();
            }
            for operand in operands {
                let is_carried = carried[value.index()].contains(&operand);
                if dataflow.is_fetched(operand) && !is_carried && !fetched[operand.index()] {
                    fetched[operand.index()] = true;
                    events.insert(chain, Event::Compute(operand));
                    chain += 1;
                }
            }
            events.push(Event::Compute(value));
            let written = outputs.get(&value).into_iter().flatten();
            events.extend(written.map(|index| Event::Output(*index)));
            before = Some(value);
        }
        for &value in last {
            if dataflow.is_fetched(value) && !std::mem::replace(&mut fetched[value.index()], true) {
                events.push(Event::Compute(value));
            }
        }
    };
    part(before_turns, &dataflow.angles, &mut events);
    events.push(Event::Turns);
    part(beyond_turns, &[], &mut events);
    // outputs that are inputs, constants, sines or cosines
    for (index, &output) in dataflow.outputs.iter().enumerate() {
        if !dataflow.is_computed(output) {
            events.push(Event::Compute(output));
            events.push(Event::Output(index));
        }
    }
    events
}

/// The number of uses of each value, and its last use.
struct Uses {
    count: Vec<usize>,
    /// The place of the last use in the list of events.
    last: Vec<usize>,
}

impl Uses {
    fn of(dataflow: &Dataflow, carried: &[Vec<ValueId>], events: &[Event]) -> Self {
        let [mut count, mut last] = [(); 2].map(|()| vec![0_usize; dataflow.values.len()]);
        for (at, event) in events.iter().enumerate() {
            let used = match *event {
                // a sine or cosine that is returned as it is
                Event::Compute(value) if dataflow.is_turn(value) => vec![value],
                Event::Compute(value) => {
                    let mut operands = dataflow.operands(value);
                    operands.retain(|operand| !carried[value.index()].contains(operand));
                    operands
                }
                Event::Output(..) => Vec::new(),
                Event::Turns => dataflow.angles.clone(),
            };
            for value in used {
                count[value.index()] += 1;
                last[value.index()] = at;
            }
        }
        Self { count, last }
    }
}

/// Assigns a slot to every value that is not used at once, from its computation to its last use.
fn allocated(dataflow: &Dataflow, carried: &[Vec<ValueId>], events: &[Event]) -> Option<Code> {
    let Uses { count: uses, last } = Uses::of(dataflow, carried, events);
    let mut memory = Memory { slots: vec![None; dataflow.values.len()], free: Vec::new(), count: 0 };
    let (mut angles, mut rest, mut turns) = (Vec::new(), Vec::new(), Vec::new());
    let (mut accumulator, mut is_turned) = (None, false);
    for (at, event) in events.iter().enumerate() {
        let into = if is_turned { &mut rest } else { &mut angles };
        match *event {
            Event::Output(index) => {
                into.push(Instruction { operation: Operation::Output(u32::try_from(index).ok()?), store: NOWHERE });
            }
            Event::Turns => {
                let turned = dataflow.values.iter().filter(|(id, _)| dataflow.is_turn(*id) && uses[id.index()] > 0);
                let turned = turned.map(|(id, value)| Some((value, memory.take(id)?)));
                let mut turned = turned.collect::<Option<Vec<_>>>()?;
                // each sine and each cosine gets one slot, even if an angle occurs twice
                let mut take_slot = |wanted: Value| {
                    let place = turned.iter().position(|(value, _)| *value == wanted);
                    place.map_or(NOWHERE, |place| turned.remove(place).1)
                };
                for &angle in &dataflow.angles {
                    let (sine, cosine) = (take_slot(Value::Sine(angle)), take_slot(Value::Cosine(angle)));
                    turns.push(Turn { angle: memory.slots[angle.index()]?, sine, cosine });
                }
                memory.release(dataflow.angles.iter().copied().filter(|angle| last[angle.index()] == at));
                accumulator = None;
                is_turned = true;
            }
            Event::Compute(value) => {
                let place = |accumulator: Option<ValueId>, operand: ValueId| {
                    if let (Some(k), true) = (dataflow.constant(operand), carried[value.index()].contains(&operand)) {
                        return Place::Constant(k);
                    }
                    match memory.slots[operand.index()] {
                        _ if accumulator == Some(operand) => Place::Accumulator,
                        Some(slot) => Place::Slot(slot),
                        None => Place::Slot(NOWHERE),
                    }
                };
                let operation = if dataflow.is_turn(value) {
                    Operation::CopyS(memory.slots[value.index()]?)
                } else {
                    operation(dataflow, value, |operand| place(accumulator, operand))
                        .or_else(|| operation(dataflow, value, |operand| place(None, operand)))?
                };
                let ended = dataflow.operands(value).into_iter().filter(|operand| last[operand.index()] == at);
                memory.release(ended);
                let uses = uses[value.index()];
                let is_taken = uses == 1 && takes_from_accumulator(dataflow, carried, &events[at + 1..], value);
                let store =
                    if is_taken || uses == 0 || dataflow.is_turn(value) { NOWHERE } else { memory.take(value)? };
                into.push(Instruction { operation, store });
                accumulator = Some(value);
            }
        }
    }
    let slots = memory.count as usize;
    Code::new(angles, turns, rest, [slots, dataflow.inputs.len(), dataflow.outputs.len()])
}

/// Whether the next value uses this one directly from the accumulator.
fn takes_from_accumulator(dataflow: &Dataflow, carried: &[Vec<ValueId>], events: &[Event], value: ValueId) -> bool {
    let next = events.iter().find(|event| !matches!(event, Event::Output(..)));
    let Some(&Event::Compute(next)) = next else { return false };
    let place = |operand: ValueId| match dataflow.constant(operand) {
        _ if operand == value => Place::Accumulator,
        Some(k) if carried[next.index()].contains(&operand) => Place::Constant(k),
        _ => Place::Slot(0),
    };
    // a constant that is part of the next instruction is loaded for a later one
    let is_operand = dataflow.operands(next).contains(&value) && !carried[next.index()].contains(&value);
    is_operand && operation(dataflow, next, place).is_some()
}

struct Memory {
    slots: Vec<Option<Slot>>,
    free: Vec<Slot>,
    count: Slot,
}

impl Memory {
    /// Returns a slot for a value: the one that was freed last, because it is in the cache.
    fn take(&mut self, value: ValueId) -> Option<Slot> {
        let slot = if let Some(slot) = self.free.pop() {
            slot
        } else {
            self.count = self.count.checked_add(1).filter(|count| *count < NOWHERE)?;
            self.count - 1
        };
        self.slots[value.index()] = Some(slot);
        Some(slot)
    }

    fn release(&mut self, values: impl Iterator<Item = ValueId>) {
        for value in values {
            self.free.extend(self.slots[value.index()].take());
        }
    }
}
