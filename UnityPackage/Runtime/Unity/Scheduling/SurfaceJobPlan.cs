// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>What is new since the last job began; later ones outweigh earlier ones.</summary>
    internal enum SurfaceChange
    {
        None,
        /// <summary>The same atoms have moved.</summary>
        Positions,
        /// <summary>Other atoms or other settings.</summary>
        Shape
    }

    /// <summary>Which levels a job computes. Levels are spacings in Å, coarsest first, the finest last.</summary>
    internal static class SurfaceJobPlan
    {
        /// <summary>
        /// Writes the levels above <paramref name="finest"/> in falling order, then the finest; what else is asked for
        /// would be refused.
        /// </summary>
        /// <param name="levels">As the user gave them: any order, any numbers.</param>
        /// <param name="finest">The spacing wanted in the end.</param>
        /// <param name="ladder">Room for <see cref="SurfaceSettings.MaxLevels"/> + 1.</param>
        /// <returns>How many there are; at least 1.</returns>
        public static int MakeLadder(ReadOnlySpan<float> levels, float finest, Span<float> ladder)
        {
            int count = 0;
            foreach (float level in levels)
            {
                if (!(level > finest) || count == SurfaceSettings.MaxLevels)
                    continue;
                int place = count;
                while (place > 0 && ladder[place - 1] < level)
                    --place;
                if (place > 0 && ladder[place - 1] == level)
                    continue;
                ladder.Slice(place, count - place).CopyTo(ladder.Slice(place + 1));
                ladder[place] = level;
                ++count;
            }
            ladder[count] = finest;
            return count + 1;
        }

        /// <summary>
        /// Chooses among the levels of a ladder. While atoms move, all of it and a budget of time, within which the
        /// library chooses; who is not alone gets the coarsest level first; what refines goes on with the next finer
        /// level. Creases cost time, and only what stays is looked at closely: the finest level, unless atoms move.
        /// </summary>
        /// <param name="settings">Gets spacing, levels and frame budget, and keeps creases or loses them.</param>
        /// <param name="ladder">Of <see cref="MakeLadder"/>.</param>
        /// <param name="change">What is new.</param>
        /// <param name="shownSpacing">Of the surface that is shown, if it is of the newest atoms; else infinite.</param>
        /// <param name="frameBudget">Milliseconds per surface while atoms move; 0: all levels.</param>
        /// <param name="othersWait">Whether other surfaces have nothing new yet.</param>
        public static void Choose(ref SurfaceSettings settings, ReadOnlySpan<float> ladder, SurfaceChange change,
            float shownSpacing, float frameBudget, bool othersWait)
        {
            int first = 0, last = ladder.Length - 1;
            settings.FrameBudget = 0;
            if (change == SurfaceChange.None)
                while (first < last && ladder[first] >= shownSpacing)
                    ++first;
            else if (change == SurfaceChange.Positions && frameBudget > 0)
                settings.FrameBudget = frameBudget;
            if (othersWait && change == SurfaceChange.Shape)
                last = first;
            settings.Spacing = ladder[last];
            settings.SetLevels(ladder.Slice(first, last - first));
            if (change == SurfaceChange.Positions || last < ladder.Length - 1)
                settings.Creases = settings.HardEdges = false;
        }
    }
}
