use std::error::Error;
use std::thread::sleep;
use std::time::Duration;
use sun2xp::{Configuration, Hand};

fn main() -> Result<(), Box<dyn Error>> {
    // The default configuration is a simulated hand. `Hand::open_configured` opens the hand of the configuration file.
    let hand = Hand::open(Configuration::default())?;
    // A fingertip that is stiff along x and soft along y and z, N/cm.
    hand.send_stiffness(1, [[3.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])?;
    // Joint angles at which the spring is at rest, rad.
    hand.send_position(1, [0.0, 0.5, 1.0])?;
    sleep(Duration::from_secs(1));
    println!("finger 1 is at {:.2?} rad", hand.position(1)?);
    hand.close();
    Ok(())
}
