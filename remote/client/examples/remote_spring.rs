//! Turns finger 1 of a hand on another machine into a soft spring, moves the finger, and prints where it is. The
//! argument is the configuration file with the table [remote].

use std::error::Error;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;
use sun2xp_remote_client::{RemoteConfiguration, RemoteHand};

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).unwrap_or("sun2xp.toml".into());
    let configuration = RemoteConfiguration::read(Path::new(&file))?
        .ok_or("the file has no table [remote]: add it (docs/remote.md)")?;
    let hand = RemoteHand::open(&configuration)?;
    hand.send_stiffness(1, [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]])?;
    hand.send_position(1, [0.0, 0.6, 0.9])?;
    while !hand.progress(1)?.arrived {
        sleep(Duration::from_millis(5));
    }
    let tip = hand.fingertip(1)?;
    println!("joints {:.3?} rad, tip {:.3?} cm, force {:.3?} N", hand.position(1)?, tip.tip, tip.force);
    hand.close()?;
    Ok(())
}
