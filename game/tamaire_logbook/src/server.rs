//! The server to which a logbook may be sent.

/// A PostgreSQL server that receives copies of a logbook's rows.
#[derive(Clone, PartialEq)]
pub struct Server {
    /// Address as the `postgres` crate parses it: `host=… user=… password=… dbname=…`, or `postgresql://…`.
    /// The connection has no TLS: a server outside the local network needs a tunnel.
    pub address: String,
}

/// Progress of sending rows to a server.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// Number of rows that the server has not received yet.
    pub unsent: u64,
    /// Reason why sending fails, as a sentence.
    pub trouble: Option<String>,
}

impl Server {
    /// Returns the name under which the logbook stores the server: its address without user and password.
    #[cfg(feature = "postgres")]
    pub(crate) fn name(&self) -> Result<String, String> {
        let config = self.config()?;
        let hosts: Vec<String> = config
            .get_hosts()
            .iter()
            .map(|host| format!("{host:?}"))
            .collect();
        let database = config
            .get_dbname()
            .or(config.get_user())
            .unwrap_or_default();
        Ok(format!(
            "{}:{:?}/{database}",
            hosts.join(","),
            config.get_ports()
        ))
    }

    #[cfg(not(feature = "postgres"))]
    pub(crate) fn name(&self) -> Result<String, String> {
        Err(
            "this program was built without the feature `postgres` and cannot send to a server"
                .into(),
        )
    }

    #[cfg(feature = "postgres")]
    pub(crate) fn config(&self) -> Result<postgres::Config, String> {
        let config = self.address.parse();
        config.map_err(|error: postgres::Error| {
            format!("the address of the server is invalid: {error}")
        })
    }
}

/// Omits the address, which may contain a password.
impl std::fmt::Debug for Server {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Server")
    }
}
