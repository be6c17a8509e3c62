//! Tests of the public interface. They are one program, because each further one adds seconds of compilation.

mod assemble_vox;
mod bodies;
mod damage;
mod embedded;
mod import_drawing;
mod import_photo;
mod import_png;
mod import_vox;
mod library;
mod machinery;
mod mistakes;
mod picture;
mod renamed_keys;
mod vox_file;
mod written;
