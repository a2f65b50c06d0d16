//! Samples averaged in bins.

/// Samples averaged in bins of the same number of samples.
#[derive(Clone, Debug, Default)]
pub(crate) struct Level {
    /// Samples in a bin.
    pub size: usize,
    /// Mean places of the bins, and mean values.
    pub tau: Vec<f64>,
    pub y: [Vec<f64>; 3],
    /// Typical distance of bins.
    pub width: f64,
    /// How many times each bin is masked. No window may contain a bin that is.
    masked: Vec<u32>,
    /// Number of bins before each one that are not evenly spaced with their neighbours.
    uneven: Vec<u32>,
}

/// Unevenness of the spacing (relative to it) that is rounding.
const ROUNDING: f64 = 1e-9;
/// A bin counts as evenly spaced where treating it so shifts its value by less than this share of its noise. Larger: more windows use
/// the precomputed functions, with larger errors.
const NEGLIGIBLE: f64 = 0.1;
/// Bins on either side from which the slope is taken: between neighbours the noise is larger than the slope.
const AROUND: usize = 6;

impl Level {
    /// Room for this many bins.
    pub fn with_capacity(bins: usize) -> Self {
        let room = || Vec::with_capacity(bins + 1);
        Self {
            size: 1,
            tau: room(),
            y: [room(), room(), room()],
            width: 0.0,
            masked: Vec::with_capacity(bins + 1),
            uneven: Vec::with_capacity(bins + 1),
        }
    }

    pub fn len(&self) -> usize {
        self.tau.len()
    }

    /// One sample a bin.
    pub fn fill(&mut self, tau: &[f64], channels: [&[f64]; 3], sigma: &[f64; 3]) {
        self.size = 1;
        self.tau.clear();
        self.tau.extend_from_slice(tau);
        for (y, channel) in self.y.iter_mut().zip(channels) {
            y.clear();
            y.extend_from_slice(channel);
        }
        self.finish(sigma);
    }

    /// The means of the pairs of a finer level.
    pub fn fill_from(&mut self, finer: &Self, sigma: &[f64; 3]) {
        self.size = 2 * finer.size;
        let mean = |pair: &[f64]| 0.5 * (pair[0] + pair[1]);
        self.tau.clear();
        self.tau.extend(finer.tau.chunks_exact(2).map(mean));
        for (y, finer) in self.y.iter_mut().zip(&finer.y) {
            y.clear();
            y.extend(finer.chunks_exact(2).map(mean));
        }
        self.finish(sigma);
    }

    fn finish(&mut self, sigma: &[f64; 3]) {
        let bins = self.len();
        self.width = if bins > 1 { (self.tau[bins - 1] - self.tau[0]) / (bins - 1) as f64 } else { 1.0 };
        self.uneven.clear();
        self.uneven.resize(bins + 1, 0);
        for i in 0..bins {
            let out = i > 0 && i + 1 < bins && self.out_of_step(i, sigma);
            self.uneven[i + 1] = self.uneven[i] + u32::from(out);
        }
        self.unmask();
    }

    fn out_of_step(&self, i: usize, sigma: &[f64; 3]) -> bool {
        let (before, after) = (self.tau[i] - self.tau[i - 1], self.tau[i + 1] - self.tau[i]);
        let out = (after - before).abs() / (after + before);
        let (low, high) = (i.saturating_sub(AROUND), (i + AROUND).min(self.len() - 1));
        let share = out / (high - low) as f64;
        out > ROUNDING && self.y.iter().zip(sigma).any(|(y, s)| share * (y[high] - y[low]).abs() > NEGLIGIBLE * s)
    }

    /// Whether bins count as evenly spaced.
    pub fn even(&self, from: usize, to: usize) -> bool {
        self.uneven[to] == self.uneven[from]
    }

    /// Lets all bins be used.
    pub fn unmask(&mut self) {
        self.masked.clear();
        self.masked.resize(self.len(), 0);
    }

    /// Leaves out the bins that hold samples `from..to`.
    pub fn mask(&mut self, (from, to): (usize, usize)) {
        self.holding(from, to).iter_mut().for_each(|masked| *masked += 1);
    }

    /// Takes back one call of [`mask`](Self::mask).
    pub fn release(&mut self, (from, to): (usize, usize)) {
        self.holding(from, to).iter_mut().for_each(|masked| *masked = masked.saturating_sub(1));
    }

    fn holding(&mut self, from: usize, to: usize) -> &mut [u32] {
        let to = to.div_ceil(self.size).min(self.masked.len());
        let from = (from / self.size).min(to);
        &mut self.masked[from..to]
    }

    /// Bins left out at a node: none at the finest level, where nodes lie between samples, and one, that may hold a
    /// transition anywhere inside, at the others.
    pub fn gap(&self) -> usize {
        usize::from(self.size > 1)
    }

    /// Bins that may be used without a break before and after a node, up to `most`; none where the node is masked.
    pub fn room(&self, node: usize, most: usize) -> (usize, usize) {
        let gap = self.gap();
        if node + gap > self.len() || (gap == 1 && self.masked[node] > 0) {
            return (0, 0);
        }
        let free = |masked: &&u32| **masked == 0;
        let left = self.masked[node.saturating_sub(most)..node].iter().rev().take_while(free).count();
        let right = self.masked[node + gap..self.len().min(node + gap + most)].iter().take_while(free).count();
        (left, right)
    }
}
