//! The thread that keeps a world up to date with the document and draws it, from coarse to exact.
//!
//! The window never waits for it: edits go into a queue, and what is drawn is looked at under a short lock. A new edit
//! stops the picture being drawn, but never the first coarse one, so that something moves however fast edits come. What
//! is left at the end is the picture of [`snell::render`], bit for bit.

use crate::{document::Changes, screen::Screen};
use snell::{
    Frame, Options, Region, Renderer, Snapshot, Stop,
    components::name::Name,
    prelude::{DetectChangesMut, Entity},
    render,
    systems::scene::{Scene, Thing},
};
use std::{
    collections::BTreeMap,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// Most pixels that are shown; larger pictures are for the command line.
pub const MOST_PIXELS: u64 = 1 << 26;

/// How long the first coarse picture may take, by estimate.
const FIRST: Duration = Duration::from_millis(16);

/// The finest coarse picture has one pixel for this many squared.
const FINEST: u32 = 4;

/// What the worker is at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// Nothing was drawn yet.
    #[default]
    Empty,
    /// Trees are built.
    Building,
    /// Coarse pictures are drawn.
    Coarse,
    /// The exact picture is drawn.
    Exact,
    /// Somebody stopped it; what was drawn is kept.
    Stopped,
    /// The picture is exact and complete.
    Done,
}

/// How to draw; changes no bit of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct How {
    /// Threads; one for each core if none.
    pub threads: Option<usize>,
    /// Whether every edit is drawn at once.
    pub live: bool,
    /// The part that is drawn exactly.
    pub region: Option<Region>,
}

impl Default for How {
    fn default() -> Self {
        Self { threads: None, live: true, region: None }
    }
}

/// What the window sees of the worker.
#[derive(Default)]
pub struct View {
    /// What the worker is at.
    pub phase: Phase,
    /// What is on the screen.
    pub screen: Screen,
    /// The scene as last drawn.
    pub snapshot: Option<Arc<Snapshot>>,
    /// The state of the document that the snapshot shows.
    pub state: u64,
    /// Why there is no new picture.
    pub error: Option<String>,
    /// Pixels drawn of the exact picture.
    pub done: u64,
    /// Pixels of the exact picture.
    pub total: u64,
    /// When the exact picture was begun.
    pub begun: Option<Instant>,
    /// How long the exact picture took.
    pub took: Duration,
    /// The exact picture, complete or as far as it came.
    pub frame: Option<Arc<Frame>>,
    /// From taking an edit to its first coarse picture.
    pub first_coarse: Option<Duration>,
}

enum Message {
    /// Another world; with it its scene and the state of the document.
    Open(Box<Renderer>, Box<Scene>, u64),
    Change(Box<Changes>, u64),
    How(How),
    Start,
}

#[derive(Default)]
struct Queue {
    messages: Vec<Message>,
    /// When the first of them came.
    since: Option<Instant>,
    /// Stops the picture being drawn.
    stop: Stop,
    /// Whether it was the user who stopped it.
    stopped: bool,
    /// Whether messages that were taken are being seen to.
    is_working: bool,
    end: bool,
}

struct Shared {
    queue: Mutex<Queue>,
    arrived: Condvar,
    view: Mutex<View>,
    repaint: Box<dyn Fn() + Send + Sync>,
}

/// A lock whose holder panicked holds what it held: pictures, which are replaced whole.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The window's end of the worker.
pub struct Worker {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread; `repaint` is called whenever there is something new to see.
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let shared = Arc::new(Shared {
            queue: Mutex::default(),
            arrived: Condvar::new(),
            view: Mutex::default(),
            repaint: Box::new(repaint),
        });
        let theirs = shared.clone();
        let thread = thread::Builder::new().name("render".into()).spawn(move || Drawer::new(theirs).run()).ok();
        Self { shared, thread }
    }

    /// Shows another world, which holds `scene`.
    pub fn open(&self, renderer: Renderer, scene: Scene, state: u64) {
        self.send(Message::Open(Box::new(renderer), Box::new(scene), state));
    }

    /// Shows the world after changes.
    pub fn change(&self, changes: Changes, state: u64) {
        self.send(Message::Change(Box::new(changes), state));
    }

    /// Draws in another way from now on.
    pub fn set_how(&self, how: How) {
        self.send(Message::How(how));
    }

    /// Draws the picture, whether or not edits are drawn at once.
    pub fn start(&self) {
        self.send(Message::Start);
    }

    /// Stops drawing; what was drawn is kept.
    pub fn stop(&self) {
        let mut queue = lock(&self.shared.queue);
        queue.stopped = true;
        queue.stop.stop();
    }

    /// What there is to see, under a lock that should be short.
    pub fn view(&self) -> MutexGuard<'_, View> {
        lock(&self.shared.view)
    }

    /// Whether something is being drawn or is about to be.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        let queue = lock(&self.shared.queue);
        queue.is_working || !queue.messages.is_empty()
    }

    fn send(&self, message: Message) {
        let mut queue = lock(&self.shared.queue);
        match (queue.messages.last_mut(), message) {
            // However fast edits come, only their sum is drawn.
            (Some(Message::Change(waiting, to)), Message::Change(changes, state)) => {
                waiting.extend(*changes);
                *to = state;
            }
            (_, message) => queue.messages.push(message),
        }
        queue.since.get_or_insert_with(Instant::now);
        queue.stop.stop();
        drop(queue);
        self.shared.arrived.notify_one();
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        let mut queue = lock(&self.shared.queue);
        queue.end = true;
        queue.stop.stop();
        drop(queue);
        self.shared.arrived.notify_one();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The thread's end.
struct Drawer {
    shared: Arc<Shared>,
    renderer: Option<Box<Renderer>>,
    things: BTreeMap<Name, Arc<Thing>>,
    entities: BTreeMap<Name, Entity>,
    how: How,
    pool: Option<rayon::ThreadPool>,
    state: u64,
    /// Whether the last picture was stopped by something new, not by the user.
    interrupted: bool,
    /// Seconds that a pixel of a coarse picture takes, as measured last.
    per_pixel: f64,
}

impl Drawer {
    fn new(shared: Arc<Shared>) -> Self {
        Self {
            shared,
            renderer: None,
            things: BTreeMap::new(),
            entities: BTreeMap::new(),
            how: How::default(),
            pool: pool(None),
            state: 0,
            interrupted: false,
            per_pixel: 5e-6,
        }
    }

    fn run(mut self) {
        loop {
            let (messages, since, stop) = {
                let mut queue = lock(&self.shared.queue);
                while queue.messages.is_empty() && !queue.end {
                    queue = self.shared.arrived.wait(queue).unwrap_or_else(PoisonError::into_inner);
                }
                if queue.end {
                    return;
                }
                queue.stop = Stop::new();
                queue.stopped = false;
                queue.is_working = true;
                (
                    std::mem::take(&mut queue.messages),
                    queue.since.take().unwrap_or_else(Instant::now),
                    queue.stop.clone(),
                )
            };
            // A shape from outside may panic: that costs its picture, not the editor.
            let done = catch_unwind(AssertUnwindSafe(|| self.work(messages, since, &stop)));
            if done.is_err() {
                let mut view = lock(&self.shared.view);
                view.phase = Phase::Stopped;
                view.error =
                    Some("drawing failed: a part of the program, perhaps a shape from outside, gave up".into());
            }
            lock(&self.shared.queue).is_working = false;
            (self.shared.repaint)();
        }
    }

    fn work(&mut self, messages: Vec<Message>, since: Instant, stop: &Stop) {
        let mut start = std::mem::take(&mut self.interrupted);
        let mut changed = false;
        for message in messages {
            match message {
                Message::Open(renderer, scene, state) => {
                    self.renderer = Some(renderer);
                    self.adopt(*scene);
                    self.state = state;
                    (start, changed) = (start | self.how.live, true);
                }
                Message::Change(changes, state) => {
                    self.change(*changes);
                    self.state = state;
                    (start, changed) = (start | self.how.live, true);
                }
                Message::How(how) => {
                    if how.threads != self.how.threads {
                        self.pool = pool(how.threads);
                    }
                    start |= how.live && (how.region != self.how.region || !self.how.live);
                    self.how = how;
                }
                Message::Start => start = true,
            }
        }
        let Some(renderer) = self.renderer.as_mut().filter(|_| start || changed) else { return };
        lock(&self.shared.view).phase = Phase::Building;
        let snapshot = match &self.pool {
            Some(pool) => pool.install(|| renderer.snapshot()),
            None => renderer.snapshot(),
        };
        let snapshot = snapshot.map_err(|why| why.to_string()).and_then(check_size);
        {
            let mut view = lock(&self.shared.view);
            view.state = self.state;
            match &snapshot {
                Ok(snapshot) => {
                    view.snapshot = Some(snapshot.clone());
                    view.error = None;
                }
                Err(why) => view.error = Some(why.clone()),
            }
            if snapshot.is_err() || !start {
                view.phase = Phase::Stopped;
                view.frame = None;
            }
        }
        if let (Ok(snapshot), true) = (snapshot, start) {
            self.draw(&snapshot, since, stop);
        }
    }

    /// Learns the entities of a new world.
    fn adopt(&mut self, scene: Scene) {
        let Some(renderer) = &mut self.renderer else { return };
        let mut names = renderer.world.query::<(Entity, &Name)>();
        self.entities = names.iter(&renderer.world).map(|(entity, name)| (name.clone(), entity)).collect();
        self.things = scene.things.into_iter().collect();
    }

    /// Brings the world to the state of the document.
    fn change(&mut self, changes: Changes) {
        let Some(renderer) = &mut self.renderer else { return };
        if let Some(settings) = changes.settings {
            renderer.settings().set_if_neq(settings);
        }
        let world = &mut renderer.world;
        // All are there before any is referred to.
        for (name, _) in changes.things.iter().filter(|(_, thing)| thing.is_some()) {
            self.entities.entry(name.clone()).or_insert_with(|| world.spawn(name.clone()).id());
        }
        let nothing = Arc::<Thing>::default();
        for (name, thing) in &changes.things {
            let (Some(thing), Some(entity)) = (thing, self.entities.get(name)) else { continue };
            let before = self.things.get(name).unwrap_or(&nothing).clone();
            if let Ok(mut entity) = world.get_entity_mut(*entity) {
                thing.put(&before, &mut entity, |name| self.entities.get(name).copied());
            }
            self.things.insert(name.clone(), thing.clone());
        }
        for (name, _) in changes.things.iter().filter(|(_, thing)| thing.is_none()) {
            self.things.remove(name);
            if let Some(entity) = self.entities.remove(name) {
                // Gone already if its parent is.
                let _ = world.try_despawn(entity);
            }
        }
    }

    fn draw(&mut self, snapshot: &Arc<Snapshot>, since: Instant, stop: &Stop) {
        let (width, height) = (snapshot.settings.width, snapshot.settings.height);
        let region = self.how.region.filter(|region| region.fits(width, height));
        let whole = Region::whole(width, height);
        {
            let mut view = lock(&self.shared.view);
            view.phase = Phase::Coarse;
            view.frame = None;
            (view.done, view.total, view.begun) = (0, region.unwrap_or(whole).area() as u64, None);
        }
        let mut stride = FINEST;
        let pixels = f64::from(width) * f64::from(height);
        while stride < 128 && pixels / f64::from(stride * stride) * self.per_pixel > FIRST.as_secs_f64() {
            stride *= 2;
        }
        let mut is_first = true;
        loop {
            // The first is never stopped, or nothing would be seen while edits keep coming.
            let stop = if is_first { Stop::new() } else { stop.clone() };
            if !self.coarse(snapshot, stride, &stop) {
                return self.stopped(None);
            }
            if is_first {
                lock(&self.shared.view).first_coarse = Some(since.elapsed());
                is_first = false;
            }
            (self.shared.repaint)();
            if stride <= FINEST {
                break;
            }
            stride = (stride / 2).max(FINEST);
        }

        let begun = Instant::now();
        {
            let mut view = lock(&self.shared.view);
            (view.phase, view.begun) = (Phase::Exact, Some(begun));
        }
        let on_tile = |tile: &snell::systems::render::Tile, so_far: snell::Progress| {
            if stop.is_stopped() {
                return;
            }
            let encoded = crate::screen::encode(&tile.pixels);
            let mut view = lock(&self.shared.view);
            view.screen.paste(tile.region, &encoded);
            view.done = view.done.max(so_far.done);
            drop(view);
            (self.shared.repaint)();
        };
        let options = Options { region, stop: stop.clone(), on_tile: Some(&on_tile), ..Options::default() };
        let frame = match &self.pool {
            Some(pool) => pool.install(|| render(snapshot, &options)),
            None => render(snapshot, &options),
        };
        lock(&self.shared.view).took = begun.elapsed();
        if frame.is_complete() {
            let mut view = lock(&self.shared.view);
            view.done = frame.done;
            view.frame = Some(Arc::new(frame));
            view.phase = Phase::Done;
        } else {
            self.stopped(Some(frame));
        }
    }

    /// Notes that a picture was not finished; a frame is kept only if the user stopped it.
    fn stopped(&mut self, frame: Option<Frame>) {
        let by_user = lock(&self.shared.queue).stopped;
        self.interrupted = !by_user;
        let mut view = lock(&self.shared.view);
        view.phase = Phase::Stopped;
        view.frame = frame.filter(|_| by_user).map(Arc::new);
    }

    /// Draws one pixel for each square of `stride` by `stride`, one ray each. Gives whether it was finished.
    fn coarse(&mut self, snapshot: &Snapshot, stride: u32, stop: &Stop) -> bool {
        let begun = Instant::now();
        let mut coarse = snapshot.clone();
        let settings = &mut coarse.settings;
        let (width, height) = (settings.width, settings.height);
        settings.width = width.div_ceil(stride);
        settings.height = height.div_ceil(stride);
        settings.antialias = snell::components::settings::Antialias::Off;
        settings.depth = settings.depth.min(4);
        let options = Options { stop: stop.clone(), tile: Some(16), ..Options::default() };
        let frame = match &self.pool {
            Some(pool) => pool.install(|| render(&coarse, &options)),
            None => render(&coarse, &options),
        };
        if !frame.is_complete() {
            return false;
        }
        self.per_pixel = begun.elapsed().as_secs_f64() / frame.picture.pixels.len().max(1) as f64;
        let encoded = crate::screen::encode(&frame.picture.pixels);
        lock(&self.shared.view).screen.stretch((width, height), (frame.picture.width, frame.picture.height), &encoded);
        true
    }
}

fn pool(threads: Option<usize>) -> Option<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build().ok()
}

/// Refuses pictures too large for a window.
fn check_size(snapshot: Arc<Snapshot>) -> Result<Arc<Snapshot>, String> {
    let (width, height) = (snapshot.settings.width, snapshot.settings.height);
    if u64::from(width) * u64::from(height) <= MOST_PIXELS {
        return Ok(snapshot);
    }
    Err(format!("{width}×{height} pixels are too many to show here; save the scene and use `snell render`"))
}
