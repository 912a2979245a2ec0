//! Configurations of motion controllers, imported: what the designs say, what is refused, and that
//! they are the firmware's machines.

mod configurations;
mod klipper;
mod linuxcnc;
mod marlin;
mod oracle;
mod platforms;
mod reprap;
mod smoothieware;
mod support;
mod traps;
