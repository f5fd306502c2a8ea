"""Checks the manifests of examples/farm against the models of Kubernetes and AWS Batch: check_manifests.py FOLDER.

Kubernetes' client library, which knows the required fields, reads an indexed job and writes it again. A field that
the library does not know is lost on the way. botocore's model of the service checks the requests to AWS Batch.
"""

import json
import pathlib
import sys

import botocore.session
import botocore.validate
import kubernetes.client
import yaml


def check_kubernetes(path):
    job = yaml.safe_load(path.read_text())
    client = kubernetes.client.ApiClient()

    class Response:
        data = json.dumps(job)

    read = client.deserialize(Response, "V1Job")
    if client.sanitize_for_serialization(read) != job:
        raise SystemExit(f"{path}: has a field that Kubernetes does not know")


def check_batch(path, operation):
    model = botocore.session.get_session().get_service_model("batch")
    shape = model.operation_model(operation).input_shape
    request = json.loads(path.read_text())
    faults = botocore.validate.ParamValidator().validate(request, shape)
    if faults.has_errors():
        raise SystemExit(f"{path}: {faults.generate_report()}")


folder = pathlib.Path(sys.argv[1])
check_kubernetes(folder / "kubernetes.yaml")
check_batch(folder / "aws-batch-definition.json", "RegisterJobDefinition")
check_batch(folder / "aws-batch-job.json", "SubmitJob")
print(f"{folder.name}: 3 manifests are what Kubernetes and AWS Batch read")
