//! Makes finger 1 of a hand on another machine a soft spring, moves it, and prints where it is. The argument is the
//! configuration file with the table [remote].

use std::error::Error;
use std::path::Path;
use std::time::Duration;
use sun2xp_remote_client::{RemoteConfiguration, RemoteHand};

const ARRIVED: u16 = 11;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).unwrap_or("sun2xp.toml".into());
    let configuration = RemoteConfiguration::read(Path::new(&file))?.ok_or("the file has no table [remote]")?;
    let hand = RemoteHand::open(&configuration)?;
    let events = hand.events();
    hand.send_stiffness(1, [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]])?;
    hand.send_position(1, [0.0, 0.6, 0.9])?;
    while let Some(event) = events.wait(Some(Duration::from_secs(5))) {
        if event.finger.number() == 1 && event.kind == ARRIVED {
            break;
        }
    }
    let tip = hand.fingertip(1)?;
    println!("joints {:.3?} rad, tip {:.3?} cm, force {:.3?} N", hand.position(1)?, tip.tip, tip.force);
    hand.close()?;
    Ok(())
}
