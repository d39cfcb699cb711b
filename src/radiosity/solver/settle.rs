//! All that is left sent at once, where the rows of all patches are kept.

use super::Solver;
use crate::factors::Share;
use crate::radiosity::groups::{GAPS, firsts, join};
use crate::radiosity::residual::Residual;
use glam::DVec3;

/// So many bounces of what is left are combined at most.
const MOST_BOUNCES: usize = 500;
/// Less than this part of what was received is rounding.
const ROUNDING: f64 = 1e-15;
/// What is found is sent if no more than this part is left of it: else nothing was found, as where nothing is absorbed.
const FOUND: f64 = 1e-3;
/// So many times what was rounded is found again.
const MOST_TIMES: usize = 4;

impl Solver<'_> {
    /// If the rows of all patches are kept, as [`Solver::compute_rows`] has them: what each patch would send in the end, with all that it would reflect, is found bounce by bounce, each of all patches, combined so that least is left (generalized conjugate
    /// residuals; Eisenstat, Elman and Schultz 1983), and sent. What is left then is rounding, and found again. True if anything was sent; not where nothing is found, as nothing is absorbed.
    ///
    /// Bounces are some tens, whatever surfaces reflect, of the cost of a pass over all factors each, where shooting takes more and more of them the less is absorbed.
    pub fn settle(&mut self) -> bool {
        let mut is_any = false;
        for _ in 0..MOST_TIMES {
            let Some(sent) = self.found() else { break };
            for (patch, sent) in sent.into_iter().enumerate() {
                let Some(row) = self.rows[patch].clone() else { break };
                if sent != DVec3::ZERO {
                    self.state.unshot[patch] -= sent;
                    self.send(patch, &row, sent);
                    is_any = true;
                }
            }
        }
        is_any
    }

    /// What all patches would send until nothing is left, as radiosities.
    fn found(&self) -> Option<Vec<DVec3>> {
        let rows = self.rows.iter().map(Option::as_deref).collect::<Option<Vec<_>>>()?;
        let count = rows.len();
        let mut groups = self.state.groups.clone();
        for row in &rows {
            let is_some = |share: Share| share.factor > share.error.max(GAPS);
            let entries = row.entries.iter().filter(|entry| is_some(entry.share));
            entries.for_each(|entry| join(&mut groups, row.patch, entry.column));
        }
        let groups = firsts(&groups);
        // As parts of the largest there is in the group, as squares have to be numbers.
        let mut unit = vec![DVec3::ZERO; count];
        for (patch, unshot) in self.state.unshot.iter().enumerate() {
            let unit = &mut unit[groups[patch] as usize];
            *unit = unit.max(unshot.abs());
        }
        for unit in &mut unit {
            *unit = DVec3::select(unit.cmpgt(DVec3::ZERO), *unit, DVec3::ONE);
        }
        let unit: Vec<DVec3> = groups.iter().map(|&group| unit[group as usize]).collect();
        let largest = (0..count).map(|patch| self.area(patch)).fold(0.0, f64::max);
        let area = |patch: usize| self.area(patch) / largest;
        let received = |sent: &dyn Fn(usize) -> DVec3| -> Vec<DVec3> {
            let mut received = vec![DVec3::ZERO; count];
            for (patch, row) in rows.iter().enumerate() {
                let power = sent(patch) * area(patch);
                for entry in &row.entries {
                    received[entry.column as usize] += power * entry.share.factor;
                }
            }
            received
                .iter()
                .enumerate()
                .map(|(patch, &power)| if power == DVec3::ZERO { power } else { power / area(patch) })
                .collect()
        };
        let own: Vec<DVec3> = self.state.unshot.iter().zip(&unit).map(|(&unshot, &unit)| unshot / unit).collect();
        // Powers are the same both ways, up to the errors of factors.
        let weights = (0..count).map(|patch| self.reflectance[patch] * area(patch)).collect();
        let first = received(&|patch| own[patch]);
        let size = |light: &[DVec3]| {
            light.iter().enumerate().map(|(k, light)| light.abs().element_sum() * area(k)).sum::<f64>()
        };
        let whole = size(&first);
        let mut residual = Residual::new(first, weights, &groups);
        for _ in 0..MOST_BOUNCES {
            if size(residual.left()) <= ROUNDING * whole {
                break;
            }
            let left = residual.left();
            let bounced = received(&|patch| self.reflectance[patch] * left[patch]);
            residual.reduce(&bounced);
        }
        let left = size(residual.left());
        if left.is_nan() || left > FOUND * whole {
            return None;
        }
        let irradiance = residual.into_solution();
        let sent = (0..count).map(|patch| (own[patch] + self.reflectance[patch] * irradiance[patch]) * unit[patch]);
        let sent: Vec<DVec3> = sent.collect();
        sent.iter().all(|sent| sent.is_finite()).then_some(sent)
    }
}
