//! What a page has said and is not done yet.

use super::protocol::Command;
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError};
use std::time::Duration;

/// What was heard.
pub enum Heard {
    /// A command.
    Command(Command),
    /// Nothing, for as long as was waited.
    Silence,
    /// The page is gone.
    Gone,
}

/// Nobody clicks more often than this while waiting for a matrix.
const MOST: usize = 64;

/// Commands in the order in which they are to be followed.
pub struct Inbox<'a> {
    commands: &'a Receiver<Command>,
    kept: VecDeque<Command>,
}

impl<'a> Inbox<'a> {
    /// Of a channel.
    pub fn new(commands: &'a Receiver<Command>) -> Self {
        Self { commands, kept: VecDeque::new() }
    }

    /// Puts a command off until [`Self::next`] is asked again, before all that come; says whether there is room.
    pub fn keep(&mut self, command: Command) -> bool {
        let room = self.kept.len() < MOST;
        if room {
            self.kept.push_back(command);
        }
        room
    }

    /// The next command, waiting as long as said, or until there is one.
    pub fn next(&mut self, wait: Option<Duration>) -> Heard {
        if let Some(command) = self.kept.pop_front() {
            return Heard::Command(command);
        }
        self.fresh(wait)
    }

    /// The next command that was not put off.
    pub fn fresh(&mut self, wait: Option<Duration>) -> Heard {
        match wait {
            Some(Duration::ZERO) => match self.commands.try_recv() {
                Ok(command) => Heard::Command(command),
                Err(TryRecvError::Empty) => Heard::Silence,
                Err(TryRecvError::Disconnected) => Heard::Gone,
            },
            Some(wait) => match self.commands.recv_timeout(wait) {
                Ok(command) => Heard::Command(command),
                Err(RecvTimeoutError::Timeout) => Heard::Silence,
                Err(RecvTimeoutError::Disconnected) => Heard::Gone,
            },
            None => self.commands.recv().map_or(Heard::Gone, Heard::Command),
        }
    }
}
