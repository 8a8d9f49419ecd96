// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using UnityEngine;

namespace QuickSes.Playback
{
    /// <summary>Plays a trajectory, and tells what that took.</summary>
    public static class LongPlay
    {
        /// <summary>Prints what <see cref="Measurement"/> prints. Not 0: the trajectory can't be read.</summary>
        public static int Run(string file, int count)
        {
            Engine.Reset();
            var scene = new GameObject("player");
            var surface = scene.AddComponent<MolecularSurface>();
            var player = scene.AddComponent<TrajectoryPlayer>();
            surface.FrameBudget = 1; // the coarsest level: what is asked about are frames, not fineness
            surface.RestDelay = float.PositiveInfinity; // frames that are read late are no rest, by a clock that runs ahead
            player.StructureSource.SetFile(file);
            player.FramesPerSecond = 60;
            player.Mode = PlaybackMode.PingPong;
            player.Interpolate = true;
            int surfaces = 0;
            surface.SurfaceUpdated += level => ++surfaces;
            surface.Failed += error => throw new InvalidOperationException(error.Message);
            if (!player.Load())
            {
                Console.Error.WriteLine(player.LastError.Message);
                return 1;
            }
            player.Play();

            Measurement.Print(count, () => Engine.Frame(1 / 60.0), () => surfaces);
            Engine.Quit();
            return 0;
        }
    }
}
