// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>What was passed while a play head moved.</summary>
    [Flags]
    internal enum PlayHeadEvents
    {
        None = 0,
        /// <summary>An end was passed, and it goes on: from the other end, or back.</summary>
        Looped = 1,
        /// <summary>An end was reached, and it goes no further.</summary>
        Finished = 2
    }

    /// <summary>A place between two frames.</summary>
    internal readonly struct FrameBlend : IEquatable<FrameBlend>
    {
        public FrameBlend(int from, int to, float weight)
        {
            From = from;
            To = to;
            Weight = weight;
        }

        /// <summary>The frame passed last, in playing direction.</summary>
        public readonly int From;

        /// <summary>The frame that comes next; the same as From on a frame and between the ends of a loop.</summary>
        public readonly int To;

        /// <summary>0: on From, towards 1: on To.</summary>
        public readonly float Weight;

        public bool Equals(FrameBlend other) => From == other.From && To == other.To && Weight == other.Weight;

        public override bool Equals(object other) => other is FrameBlend blend && Equals(blend);

        public override int GetHashCode() => From;
    }

    /// <summary>
    /// Where in a trajectory playback is. Every frame is shown for one unit from when it is reached: in a loop, the one
    /// at the end too before the other end follows, without anything between the two. A value; knows no clock.
    /// </summary>
    internal struct PlayHead
    {
        // Between -1 and FrameCount, both excluded. Below 0 and above FrameCount - 1: a loop lingers at its end.
        private double _position;
        private int _sign;
        private int _turn; // -1 while ping-pong is on its way back

        public PlayHead(int frameCount, PlaybackMode mode)
        {
            FrameCount = frameCount;
            Mode = mode;
            _position = 0;
            _sign = 1;
            _turn = 1;
        }

        /// <summary>At least 1.</summary>
        public int FrameCount { get; }

        public PlaybackMode Mode { get; private set; }

        /// <summary>1: towards higher frames, -1: towards lower ones.</summary>
        public int Direction => _sign * _turn;

        /// <summary>From 0 to FrameCount - 1.</summary>
        public double Position => Clamp(_position);

        /// <summary>The frame reached last.</summary>
        public int Frame => (int)(Direction > 0 ? Math.Floor(Position) : Math.Ceiling(Position));

        public FrameBlend Blend
        {
            get
            {
                int from = Frame;
                double weight = Math.Abs(Position - from);
                return new FrameBlend(from, weight > 0 ? from + Direction : from, (float)weight);
            }
        }

        /// <summary>Goes to a place, clamped to the trajectory. A way back of ping-pong stays one.</summary>
        public void MoveTo(double position) => _position = double.IsNaN(position) ? 0 : Clamp(position);

        public void SetMode(PlaybackMode mode)
        {
            if (mode == Mode)
                return;
            Mode = mode;
            _turn = 1;
            _position = Clamp(_position);
        }

        /// <summary>Which way <see cref="Advance"/> goes: 1 or -1. A new one undoes the turn of a ping-pong.</summary>
        public void SetSign(int sign)
        {
            if (sign == _sign)
                return;
            _sign = sign;
            _turn = 1;
            _position = Clamp(_position);
        }

        /// <summary>Back to the end where playing begins, on the way out.</summary>
        public void Rewind()
        {
            _turn = 1;
            _position = _sign > 0 ? 0 : FrameCount - 1;
        }

        /// <summary>Whether Advance would go nowhere, since the way has been played once.</summary>
        public bool IsAtEnd => Mode == PlaybackMode.Once &&
            (Direction > 0 ? _position >= FrameCount - 1 : _position <= 0);

        /// <param name="frames">How far, in playing direction; 0 or more.</param>
        public PlayHeadEvents Advance(double frames)
        {
            if (!(frames > 0))
                return PlayHeadEvents.None;
            switch (Mode)
            {
                case PlaybackMode.Once:
                    return AdvanceOnce(frames);
                case PlaybackMode.PingPong:
                    return AdvancePingPong(frames);
                default:
                    return AdvanceLoop(frames);
            }
        }

        private PlayHeadEvents AdvanceOnce(double frames)
        {
            _position = Clamp(_position + frames * Direction);
            return IsAtEnd ? PlayHeadEvents.Finished : PlayHeadEvents.None;
        }

        private PlayHeadEvents AdvanceLoop(double frames)
        {
            double moved = _position + frames * Direction;
            // Forwards a loop is [0, n), backwards (-1, n - 1].
            double behind = Direction > 0 ? moved : FrameCount - 1 - moved;
            if (behind < FrameCount)
            {
                _position = moved;
                return PlayHeadEvents.None;
            }
            behind %= FrameCount;
            _position = Direction > 0 ? behind : FrameCount - 1 - behind;
            return PlayHeadEvents.Looped;
        }

        private PlayHeadEvents AdvancePingPong(double frames)
        {
            int last = FrameCount - 1;
            if (last == 0)
                return PlayHeadEvents.None;
            double way = Direction > 0 ? _position : 2.0 * last - _position; // unrolled: out to last, back to 2 last
            double moved = way + frames;
            bool turned = Math.Floor(moved / last) > Math.Floor(way / last);
            moved %= 2.0 * last;
            bool isOut = moved < last;
            _position = isOut ? moved : 2.0 * last - moved;
            _turn = (isOut ? 1 : -1) * _sign;
            return turned ? PlayHeadEvents.Looped : PlayHeadEvents.None;
        }

        private double Clamp(double position) => Math.Max(0, Math.Min(FrameCount - 1, position));

        /// <summary>The frames that follow, for those who read ahead.</summary>
        public FrameOrder Order => new FrameOrder(FrameCount, Mode, Direction, Frame);
    }
}
