//! Where a logbook may be sent.

/// A PostgreSQL server.
#[derive(Clone, PartialEq)]
pub struct Server {
    /// As the `postgres` crate reads it: `host=… user=… password=… dbname=…`, or `postgresql://…`. There is no TLS: a server that
    /// is not in the same house is reached through a tunnel.
    pub address: String,
}

/// How it goes with a server.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// How many rows it has not got yet.
    pub unsent: u64,
    /// Why not: a sentence.
    pub trouble: Option<String>,
}

impl Server {
    /// By what it is known in a file: its address without what is secret.
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
        Err("this program was built without what sends to a server".into())
    }

    #[cfg(feature = "postgres")]
    pub(crate) fn config(&self) -> Result<postgres::Config, String> {
        let config = self.address.parse();
        config.map_err(|error: postgres::Error| {
            format!("the address of the server cannot be read: {error}")
        })
    }
}

/// Without the address, which may hold a password.
impl std::fmt::Debug for Server {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("Server")
    }
}
