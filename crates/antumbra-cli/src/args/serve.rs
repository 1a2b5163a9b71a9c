//! The options of `antumbra serve`.

use std::{net::IpAddr, path::PathBuf};

use crate::failure::EXIT_CODES;

const SERVE_EXAMPLES: &str = "\
Examples:
  antumbra serve                                    # the page that crates/antumbra-web/build has made, for this machine only
  antumbra serve ~/antumbra-page --port 9000
  antumbra serve --address 0.0.0.0                  # for everybody who can reach this machine

The browser computes everything; this program only hands out the files of the folder, as they were when it began.";

/// Hand out the web page, where formulas are typed and turned around in a browser.
///
/// For this machine only, unless another address is named. Ctrl-C ends it.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{SERVE_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct ServeArgs {
    /// Folder of the page, as crates/antumbra-web/build makes it
    #[arg(value_name = "DIR", default_value = "target/web")]
    pub(crate) folder: PathBuf,

    /// Address to listen on
    #[arg(long, value_name = "IP", default_value = "127.0.0.1")]
    pub(crate) address: IpAddr,

    /// Port to listen on; 0 takes any that is free
    #[arg(long, value_name = "N", default_value = "8018")]
    pub(crate) port: u16,
}
