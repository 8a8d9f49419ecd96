// SPDX-License-Identifier: MIT
using UnityEngine;

namespace UnityEditor
{
    public sealed class Selection
    {
        public static GameObject activeGameObject { get; set; }
    }
}
