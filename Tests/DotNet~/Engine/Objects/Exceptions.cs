// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    public class UnityException : Exception
    {
        public UnityException()
        {
        }

        public UnityException(string message) : base(message)
        {
        }
    }

    public class MissingReferenceException : SystemException
    {
        public MissingReferenceException()
        {
        }

        public MissingReferenceException(string message) : base(message)
        {
        }
    }
}
