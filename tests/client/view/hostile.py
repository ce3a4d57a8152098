# SPDX-License-Identifier: GPL-3.0-or-later
"""A server that means harm: it passes calls on to a real one, and puts hostile text into all names, titles, warnings,
reasons, units and errors of what that answers. The real one stores no such text."""
import contextlib
from concurrent import futures

import grpc
from google.protobuf import descriptor_pb2, message_factory

from anticrack.v1 import case_pb2, mesh_pb2, server_pb2, solve_pb2, upload_pb2

HOSTILE = '<img src=x onerror="window.harmed=1"><script>window.harmed=1</script>\u202e\u2066'
LONG = HOSTILE + 65536 * "x"
# What programs read: names of jobs and arrays, and marks of pages and content.
_KEPT = ("mesh", "upload", "sha256", "parent", "job", "next_page_token", "levels_sha256", "toml", "field")
_FILLED = ("title", "owner", "reason", "not_reached", "no_bracket", "detail", "forecast")
_LONG = ("title", "warnings", "reason", "detail", "meaning", "notes", "growth_notes")


def _bent(field, text):
    """The same for the same text, as names refer to each other."""
    known = field.name in _KEPT or "/" in text or field.containing_type.name == "ArrayLayout"
    return text if known or not text and field.name not in _FILLED else (
        LONG if field.name in _LONG else HOSTILE) + text


def bend(message):
    for field in message.DESCRIPTOR.fields:
        value, many = getattr(message, field.name), field.label == field.LABEL_REPEATED
        if field.message_type is not None:
            for part in value if many else [value] * message.HasField(field.name):
                bend(part)
        elif field.type == field.TYPE_STRING and many:
            value[:] = [_bent(field, text) for text in [*value, *[""] * (field.name == "warnings")]]
            if field.name == "warnings":
                value[-1] = LONG
        elif field.type == field.TYPE_STRING and field.containing_oneof is None and (bent := _bent(field, value)):
            setattr(message, field.name, bent)


class _Passed(grpc.GenericRpcHandler):
    def __init__(self, channel):
        self._channel, self._methods = channel, {}
        for file in (case_pb2, mesh_pb2, server_pb2, solve_pb2, upload_pb2):
            for service in file.DESCRIPTOR.services_by_name.values():
                told = descriptor_pb2.ServiceDescriptorProto()
                service.CopyToProto(told)
                for method, of in zip(service.methods, told.method):
                    self._methods[f"/{service.full_name}/{method.name}"] = method.output_type, of.server_streaming

    def service(self, handler_call_details):
        kind, streams = self._methods[handler_call_details.method]
        call = (self._channel.unary_stream if streams else self._channel.unary_unary)(
            handler_call_details.method,
            response_deserializer=message_factory.MessageFactory().GetPrototype(kind).FromString)

        def answers(request, context):
            try:
                answer = call(request)
                for message in answer if streams else [answer]:
                    bend(message)
                    yield message.SerializeToString()
            except grpc.RpcError as error:
                context.abort(error.code(), LONG[:4000])
        if streams:
            return grpc.unary_stream_rpc_method_handler(answers)
        return grpc.unary_unary_rpc_method_handler(lambda request, context: next(answers(request, context)))


@contextlib.contextmanager
def hostile(port):
    """Serves what the server at `port` does; yields its own port."""
    with grpc.insecure_channel(f"127.0.0.1:{port}") as channel:
        server = grpc.server(futures.ThreadPoolExecutor(16), [_Passed(channel)])
        own = server.add_insecure_port("127.0.0.1:0")
        server.start()
        try:
            yield own
        finally:
            server.stop(0.5).wait()
