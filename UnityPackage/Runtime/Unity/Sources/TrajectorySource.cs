// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Where frames come from: DCD, XTC, TRR, NetCDF or PDB with several models, each also gzipped. Of kind None: the file of the
    /// structure, which must then be a PDB file with several models. Serialised with the component it belongs to. Main
    /// thread only.
    /// </summary>
    [Serializable]
    public sealed class TrajectorySource : FileSource
    {
        [SerializeField, Tooltip("Auto: by the name, also before .gz, .bytes and .txt, else by the content.")]
        private TrajectoryFormat _format = TrajectoryFormat.Auto;

        /// <summary>Auto (default): by the name, also before ".gz", ".bytes" and ".txt", else by the content.</summary>
        public TrajectoryFormat Format { get => _format; set => _format = value; }

        /// <summary>Only where a file is, to compare others with.</summary>
        internal static TrajectorySource OfFile(FileSource source)
        {
            var copy = new TrajectorySource();
            copy.CopyFileFrom(source);
            return copy;
        }

        internal bool HasFileOf(FileSource source) => HasSameFileAs(source);

        /// <summary>As it is now, also if its asset is imported anew later.</summary>
        internal TrajectorySource Copy()
        {
            var copy = (TrajectorySource)MemberwiseClone();
            copy.KeepContent();
            return copy;
        }

        internal void CopyFrom(TrajectorySource other)
        {
            CopyFileFrom(other);
            _format = other._format;
        }

        internal bool IsSameAs(TrajectorySource other) => HasSameContentAs(other) && _format == other._format;
    }
}
