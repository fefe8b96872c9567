//! `stridor schema`: what a case file may say, for editors and for people.

use super::output::{Common, SUCCESS, give};
use crate::case::Case;
use crate::error::Result;
use crate::schema::{describe, json_schema, key_reference};
use clap::Args;

#[derive(Args)]
pub struct SchemaOptions {
    /// Print the reference of all keys in Markdown instead
    #[arg(long)]
    markdown: bool,
}

pub fn run(options: &SchemaOptions, _: &Common) -> Result<u8> {
    let case = describe::<Case>();
    match options.markdown {
        true => give(format!("# Keys of a case file\n\n{}", key_reference(&case).trim_end()))?,
        false => give(of_cases())?,
    }
    Ok(SUCCESS)
}

/// The JSON Schema of case files.
pub(super) fn of_cases() -> String {
    format!("{:#}", json_schema("A case of stridor", &describe::<Case>()))
}
