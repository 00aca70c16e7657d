//! Reading and writing of files.

pub(crate) mod chosen_arm;
pub(crate) mod class_states;
pub(crate) mod csv_table;
pub(crate) mod file_name;
pub(crate) mod input_file;
pub(crate) mod interruption;
pub(crate) mod motion_file;
pub(crate) mod motion_log;
pub(crate) mod output_file;
pub(crate) mod output_folder;
pub(crate) mod plan_file;
pub(crate) mod reading;
pub(crate) mod robot_file;
pub(crate) mod state_results;
pub(crate) mod state_table;
pub(crate) mod states;
pub(crate) mod trajectory_file;
pub(crate) mod worksheet_file;
pub(crate) mod worksheet_text;
