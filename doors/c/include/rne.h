/* rne: the dynamics of robot arms, compiled when a robot file is read. Link with -lrne; docs/firmware/c-library.md shows how.
 *
 * Units: rad, rad/s, rad/s² and N m for revolute joints; m, m/s, m/s² and N for prismatic ones; kg, kg m². Joints are
 * counted from 0 at the base. Arrays of joints have rne_arm_dof() elements.
 *
 * Ownership: an arm is yours from rne_arm_load_…() or rne_arm_builtin() until rne_arm_free(). Texts that are returned are
 * the library's; each says how long it stays. Nothing that you pass is kept after a call.
 *
 * Threads: every function may be called from any thread, with one arm from many at once; only rne_arm_free() must come
 * after the last other call with its arm. rne_last_error() is that of the calling thread.
 *
 * Errors: a function that can fail returns a status, and writes nothing but NULL to a place for an arm then. NULL, counts,
 * alignment and shared memory are checked. Not checked, for C cannot tell: that pointers point to as much as is said, and
 * that an arm is one which was not freed. A `count` that is larger than an array is undefined behaviour. */

#ifndef RNE_H
#define RNE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * What a call came to. Everything but RNE_STATUS_OK leaves a message for rne_last_error().
 */
typedef enum rne_status {
  /**
   * It is done.
   */
  RNE_STATUS_OK = 0,
  /**
   * A pointer is NULL that must not be.
   */
  RNE_STATUS_NULL_POINTER = 1,
  /**
   * A text is not UTF-8.
   */
  RNE_STATUS_NOT_UTF8 = 2,
  /**
   * A file cannot be read: the message has the path and what the operating system says.
   */
  RNE_STATUS_UNREADABLE_FILE = 3,
  /**
   * A robot file, a plan file or a URDF is wrong: the message shows each mistake with its line and column.
   */
  RNE_STATUS_INVALID_FILE = 4,
  /**
   * There is no robot, function or argument of this name: the message lists those there are.
   */
  RNE_STATUS_UNKNOWN_NAME = 5,
  /**
   * There is no function of this id, no joint or argument of this index; or the mass of a payload is below zero.
   */
  RNE_STATUS_OUT_OF_RANGE = 6,
  /**
   * An argument that the function takes is not among the inputs.
   */
  RNE_STATUS_MISSING_ARGUMENT = 7,
  /**
   * An input has too few numbers, is there twice, or the room for the outputs has another size.
   */
  RNE_STATUS_WRONG_SIZE = 8,
  /**
   * An array or a place is not aligned for its values, an array is larger than memory can be, or outputs and an
   * input share memory.
   */
  RNE_STATUS_WRONG_MEMORY = 9,
  /**
   * The function cannot be compiled for this arm: the message says why.
   */
  RNE_STATUS_CANNOT_COMPILE = 10,
  /**
   * A mistake in this library. Nothing was returned; the arm can still be used.
   */
  RNE_STATUS_PANIC = 11,
} rne_status;

/**
 * How a joint moves: which units its position, rate, acceleration and torque have.
 */
typedef enum rne_joint_kind {
  /**
   * About its axis: rad, rad/s, rad/s², N m.
   */
  RNE_JOINT_KIND_REVOLUTE = 0,
  /**
   * Along its axis: m, m/s, m/s², N.
   */
  RNE_JOINT_KIND_PRISMATIC = 1,
} rne_joint_kind;

/**
 * An arm. Its functions are compiled when they are first called, once; any number of threads may use it at once.
 *
 * What it points to is this library's: made by rne_arm_load_file() and its like, freed by rne_arm_free().
 */
typedef struct rne_arm rne_arm;

/**
 * What a joint may do. Infinite where the robot file says nothing.
 */
typedef struct rne_limits {
  /**
   * Lower end of its position, rad or m.
   */
  double lower;
  /**
   * Upper end of its position, rad or m.
   */
  double upper;
  /**
   * Largest speed, rad/s or m/s.
   */
  double velocity;
  /**
   * Largest torque or force, N m or N.
   */
  double effort;
} rne_limits;

/**
 * An argument of a function, in double precision. Element j of state s is data[s * state_stride + j * element_stride].
 *
 * `{.name = "q", .data = q, .count = 6}` is one row for all states; with .state_stride = 6 it is a row for each.
 */
typedef struct rne_input {
  /**
   * Which argument: "q", "qd", "qdd", "tau", …; rne_function_argument() tells them.
   */
  const char *name;
  /**
   * Its numbers. They are read during the call alone.
   */
  const double *data;
  /**
   * How many numbers there are at data; reading ends before.
   */
  size_t count;
  /**
   * How far apart states are, in numbers; 0 where all states have the same. One state needs none.
   */
  size_t state_stride;
  /**
   * How far apart elements are, in numbers; 0 means 1.
   */
  size_t element_stride;
} rne_input;

/**
 * An argument of a function, in single precision: as rne_input.
 */
typedef struct rne_input_f32 {
  /**
   * Which argument.
   */
  const char *name;
  /**
   * Its numbers.
   */
  const float *data;
  /**
   * How many numbers there are at data.
   */
  size_t count;
  /**
   * How far apart states are; 0 where all states have the same.
   */
  size_t state_stride;
  /**
   * How far apart elements are; 0 means 1.
   */
  size_t element_stride;
} rne_input_f32;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of this library, such as "0.1.0": a text that stays.
 */
const char *rne_version(void);

/**
 * Why the last call of this thread that failed did: one line or, of a file, several. Empty before the first.
 *
 * The text is this library's, and stays until the next failure of the same thread. A success leaves it as it is.
 */
const char *rne_last_error(void);

/**
 * Reads a robot file, and the plan file beside it (NAME.plan.yaml) where there is one; or gives a built-in robot, if
 * `path` is its name and no file.
 *
 * `path` is in UTF-8; one that is relative starts at the working directory. The arm goes to `*arm`, to be freed by
 * rne_arm_free(); after a failure `*arm` is NULL. The same text read again gives the same arm, compiled.
 */
enum rne_status rne_arm_load_file(const char *path,
                                  struct rne_arm **arm);

/**
 * Reads the text of a robot file: as rne_arm_load_file().
 */
enum rne_status rne_arm_load_text(const char *yaml, struct rne_arm **arm);

/**
 * Makes an arm of a chain of a URDF, in standard rows; no angle is taken for a near multiple of pi/12.
 *
 * `base` and `tip` name the links at its ends: NULL is the root, and the one leaf of the tree. The movable joints
 * `lock_names[0 … lock_count - 1]` stand still at `lock_values`, rad or m; with `lock_others` every other movable
 * joint off the chain does, at zero.
 */
enum rne_status rne_arm_load_urdf(const char *path,
                                  const char *base,
                                  const char *tip,
                                  const char *const *lock_names,
                                  const double *lock_values,
                                  size_t lock_count,
                                  bool lock_others,
                                  struct rne_arm **arm);

/**
 * A robot of the box by its name, "puma560" say, with its plan.
 */
enum rne_status rne_arm_builtin(const char *name, struct rne_arm **arm);

/**
 * Makes an arm with a frame in the place of the tip: the pose, the Jacobian, its rate and derivatives, and the torques
 * of a wrench are those of the frame. The other functions of the new arm are those of the tip.
 *
 * `frame` is the name of a frame in the list `frames` of the robot file, or the name of a joint for its link frame.
 * The new arm goes to `*at`, to be freed by rne_arm_free() as `arm` is; either may be freed first. After a failure
 * `*at` is NULL.
 */
enum rne_status rne_arm_at_frame(const struct rne_arm *arm,
                                 const char *frame,
                                 struct rne_arm **at);

/**
 * Frees an arm, and the names that it gave out; NULL is let pass. No other call may be using it, or use it later.
 */
void rne_arm_free(struct rne_arm *arm);

/**
 * The robot's name: a text of the arm's, which goes with it. NULL when `arm` is.
 */
const char *rne_arm_name(const struct rne_arm *arm);

/**
 * How many joints it has; 0 when `arm` is NULL.
 */
size_t rne_arm_dof(const struct rne_arm *arm);

/**
 * The name of a joint, counted from 0 at the base: a text of the arm's, which goes with it. NULL when there is no such
 * joint, or `arm` is NULL.
 */
const char *rne_arm_joint_name(const struct rne_arm *arm,
                               size_t joint);

/**
 * Whether a joint turns or slides: which units its numbers have.
 */
enum rne_status rne_arm_joint_kind(const struct rne_arm *arm, size_t joint, enum rne_joint_kind *kind);

/**
 * What a joint may do, by the robot file.
 */
enum rne_status rne_arm_joint_limits(const struct rne_arm *arm, size_t joint, struct rne_limits *limits);

/**
 * The id of a function by its name: "inverse_dynamics", "mass_matrix", …; `docs/reference/functions.md` has them all.
 * An id is that of every arm. It may be another in another version of this library: do not store it.
 */
enum rne_status rne_function_find(const char *name,
                                  uint32_t *id);

/**
 * How many functions there are: their ids are 0 and those up to it.
 */
uint32_t rne_function_count(void);

/**
 * Compiles a function of an arm now, in some ten milliseconds; otherwise its first use does.
 */
enum rne_status rne_function_prepare(const struct rne_arm *arm, uint32_t id);

/**
 * How many numbers a function returns for a state: a matrix row by row, a pose as the rotation row by row and then the
 * translation, a wrench as force and then moment.
 */
enum rne_status rne_function_outputs(const struct rne_arm *arm,
                                     uint32_t id,
                                     size_t *outputs);

/**
 * How many arguments a function takes. It is compiled for it, as by rne_function_prepare().
 */
enum rne_status rne_function_arguments(const struct rne_arm *arm, uint32_t id, size_t *arguments);

/**
 * An argument of a function, counted from 0: its name and how many elements it has for a state. The name stays as long
 * as the program. Either place may be NULL.
 */
enum rne_status rne_function_argument(const struct rne_arm *arm,
                                      uint32_t id,
                                      size_t argument,
                                      const char **name,
                                      size_t *elements);

/**
 * Computes a function for one state, in double precision.
 *
 * `outputs` has room for `output_count` numbers, just as many as rne_function_outputs() tells. Inputs that the
 * function does not take are not read. After a failure nothing has been written. The second call of a thread and those
 * that follow allocate nothing, take no lock and do not call the operating system; the first allocates what the thread
 * keeps, and compiles the function unless rne_function_prepare() has. A failure allocates its message.
 */
enum rne_status rne_evaluate(const struct rne_arm *arm,
                             uint32_t id,
                             const struct rne_input *inputs,
                             size_t input_count,
                             double *outputs,
                             size_t output_count);

/**
 * Computes a function for so many states, in double precision, in the calling thread, on its widest vector unit.
 *
 * `outputs` has room for `output_count` numbers: `states` rows of as many as rne_function_outputs() tells. Each row
 * has the bits that rne_evaluate() gives that state. Otherwise as rne_evaluate(), but that some hundred bytes are
 * allocated.
 */
enum rne_status rne_evaluate_batch(const struct rne_arm *arm,
                                   uint32_t id,
                                   size_t states,
                                   const struct rne_input *inputs,
                                   size_t input_count,
                                   double *outputs,
                                   size_t output_count);

/**
 * rne_evaluate_batch() in so many threads, the caller's among them; `threads` of 0 is one for each core.
 *
 * The others are started and end within the call, each with some thousand states at a time: fewer states take fewer
 * threads. Every row has the bits that it has otherwise. Where the system gives no thread, those that there are do
 * all.
 */
enum rne_status rne_evaluate_batch_threads(const struct rne_arm *arm,
                                           uint32_t id,
                                           size_t threads,
                                           size_t states,
                                           const struct rne_input *inputs,
                                           size_t input_count,
                                           double *outputs,
                                           size_t output_count);

/**
 * rne_evaluate() in single precision.
 */
enum rne_status rne_evaluate_f32(const struct rne_arm *arm,
                                 uint32_t id,
                                 const struct rne_input_f32 *inputs,
                                 size_t input_count,
                                 float *outputs,
                                 size_t output_count);

/**
 * rne_evaluate_batch() in single precision.
 */
enum rne_status rne_evaluate_batch_f32(const struct rne_arm *arm,
                                       uint32_t id,
                                       size_t states,
                                       const struct rne_input_f32 *inputs,
                                       size_t input_count,
                                       float *outputs,
                                       size_t output_count);

/**
 * rne_evaluate_batch_threads() in single precision.
 */
enum rne_status rne_evaluate_batch_threads_f32(const struct rne_arm *arm,
                                               uint32_t id,
                                               size_t threads,
                                               size_t states,
                                               const struct rne_input_f32 *inputs,
                                               size_t input_count,
                                               float *outputs,
                                               size_t output_count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* RNE_H */
