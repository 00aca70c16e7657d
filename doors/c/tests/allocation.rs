//! What a controller relies on: after its first, a call allocates nothing.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::ptr::null_mut;
use std::sync::atomic::{AtomicUsize, Ordering};

use rne::Status;
use rne::border::{Input, rne_arm_builtin, rne_arm_free, rne_evaluate, rne_function_find, rne_function_outputs};

/// How often memory was asked for.
static COUNT: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: all is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        COUNT.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn one_state_allocates_nothing() {
    let mut arm = null_mut();
    let q = [0.3; 7];
    let names = [c"q", c"qd", c"qdd", c"tau"];
    let input = |name: &std::ffi::CStr| Input {
        name: name.as_ptr(),
        data: q.as_ptr(),
        count: 7,
        state_stride: 0,
        element_stride: 0,
    };
    let inputs = names.map(input);
    let mut outputs = [0.0; 500];
    // SAFETY: texts, slices and places.
    unsafe {
        assert_eq!(rne_arm_builtin(c"panda".as_ptr(), &raw mut arm), Status::Ok);
        for name in [c"inverse_dynamics", c"mass_matrix", c"forward_dynamics", c"jacobian", c"regressor"] {
            let (mut id, mut count) = (0, 0);
            assert_eq!(rne_function_find(name.as_ptr(), &raw mut id), Status::Ok);
            assert_eq!(rne_function_outputs(arm, id, &raw mut count), Status::Ok);
            let mut call = || rne_evaluate(arm, id, inputs.as_ptr(), inputs.len(), outputs.as_mut_ptr(), count);
            assert_eq!(call(), Status::Ok);
            let before = COUNT.load(Ordering::Relaxed);
            for _ in 0..1000 {
                assert_eq!(call(), Status::Ok);
            }
            assert_eq!(COUNT.load(Ordering::Relaxed), before, "{name:?}");
        }
        rne_arm_free(arm);
    }
}
