//! `antumbra serve`: hands out the web page.

mod site;

use std::{convert::Infallible, future::Future, net::SocketAddr, sync::Arc, time::Duration};

use anyhow::{Context, Result};
use hyper::{body::Incoming, server::conn::http1, service::service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::{
    net::{TcpListener, TcpStream},
    sync::Semaphore,
    time,
};

use crate::{args::ServeArgs, output};
use site::Site;

/// Connections at a time; more wait.
const CONNECTIONS: usize = 64;
/// A request's head is there within this, and has at most so many bytes.
const HEAD_TIME: Duration = Duration::from_secs(10);
const HEAD_BYTES: usize = 16 << 10;
/// A connection is closed after this, whatever it does.
const CONNECTION_TIME: Duration = Duration::from_secs(120);
/// Pause after an error of the listener: it may have run out of files, and goes on when connections end.
const PAUSE: Duration = Duration::from_millis(100);

/// Serves until the process ends.
///
/// # Errors
/// Where there is no page, or the address cannot be listened on.
pub(super) fn run(args: &ServeArgs) -> Result<()> {
    let site = Arc::new(Site::read(&args.folder)?);
    let runtime =
        tokio::runtime::Builder::new_current_thread().enable_all().build().context("cannot start to serve")?;
    let address = SocketAddr::new(args.address, args.port);
    runtime.block_on(async {
        let listener = TcpListener::bind(address).await;
        let listener = listener.with_context(|| {
            format!("cannot listen on {address}; another port can be named with --port, and 0 takes any that is free")
        })?;
        output::print(&format!("http://{}/\n", listener.local_addr().context("cannot tell the address")?))?;
        serve(&listener, &site).await
    })
}

async fn serve(listener: &TcpListener, site: &Arc<Site>) -> Result<()> {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    loop {
        let place = Arc::clone(&places).acquire_owned().await.context("cannot go on serving")?;
        let Ok((stream, _)) = listener.accept().await else {
            time::sleep(PAUSE).await;
            continue;
        };
        let talk = time::timeout(CONNECTION_TIME, connection(stream, Arc::clone(site)));
        tokio::spawn(async move {
            // A connection that broke off is no matter of ours.
            let _ = talk.await;
            drop(place);
        });
    }
}

/// Answers the requests of one connection, one after the other.
fn connection(stream: TcpStream, site: Arc<Site>) -> impl Future<Output = hyper::Result<()>> {
    let answer = service_fn(move |request: hyper::Request<Incoming>| {
        let answer = site.answer(request.method(), request.uri().path());
        async move { Ok::<_, Infallible>(answer) }
    });
    http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIME)
        .max_buf_size(HEAD_BYTES)
        .serve_connection(TokioIo::new(stream), answer)
}
