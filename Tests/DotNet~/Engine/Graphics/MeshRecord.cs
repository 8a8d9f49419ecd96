// SPDX-License-Identifier: MIT
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.EngineDouble
{
    /// <summary>What was done to a mesh since it was made, or since <see cref="Clear"/>.</summary>
    public sealed class MeshRecord
    {
        /// <summary>Of all meshes, since the program began.</summary>
        public static long AllBytesUploaded { get; internal set; }

        /// <summary>Of the mesh, alive or destroyed.</summary>
        public static MeshRecord Of(Mesh mesh) => mesh.Record;

        public int VertexParamsCalls { get; internal set; }

        public int IndexParamsCalls { get; internal set; }

        public int VertexUploads { get; internal set; }

        public int IndexUploads { get; internal set; }

        public int SubMeshCalls { get; internal set; }

        /// <summary>Each waits for the thread that draws.</summary>
        public int NativePointerCalls { get; internal set; }

        public long BytesUploaded { get; internal set; }

        /// <summary>Flags of all uploads and of SetSubMesh that each of them had; all, before the first.</summary>
        public MeshUpdateFlags FlagsOfEach { get; private set; } = ~MeshUpdateFlags.Default;

        /// <summary>
        /// True from a change with DontNotifyMeshUsers to the next MarkModified, or change without it.
        /// </summary>
        public bool AwaitsNotification { get; private set; }

        /// <summary>Lets there be no memory for its indices.</summary>
        public bool RefusesIndices { get; set; }

        internal bool IsChecked { get; set; } = true;

        /// <summary>The bounds that those who use the mesh were told.</summary>
        internal Bounds NotifiedBounds { get; private set; }

        public void Clear()
        {
            VertexParamsCalls = IndexParamsCalls = VertexUploads = IndexUploads = SubMeshCalls = NativePointerCalls = 0;
            BytesUploaded = 0;
            FlagsOfEach = ~MeshUpdateFlags.Default;
        }

        internal void NoteBytes(long bytes)
        {
            BytesUploaded += bytes;
            AllBytesUploaded += bytes;
        }

        internal void NoteChange(Mesh mesh, MeshUpdateFlags flags)
        {
            FlagsOfEach &= flags;
            Change(mesh);
            if ((flags & MeshUpdateFlags.DontNotifyMeshUsers) != 0)
                AwaitsNotification = true;
            else
                Notify(mesh);
        }

        internal void Change(Mesh mesh)
        {
            if (!IsChecked)
                return;
            IsChecked = false;
            MeshCheck.NoteChange(mesh);
        }

        internal void Notify(Mesh mesh)
        {
            AwaitsNotification = false;
            NotifiedBounds = mesh.Buffers.Bounds;
        }
    }
}
