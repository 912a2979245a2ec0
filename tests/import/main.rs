//! Configurations of motion controllers, imported: what the designs say, what is refused, and that
//! they are the firmware's machines.

mod klipper;
mod linuxcnc;
mod oracle;
mod support;
